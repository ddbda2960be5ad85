#include "astroid/analysis/focal_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "astroid/core/distributions.hpp"

namespace astroid {
namespace {

constexpr Rectangle kDetector{0, 0, 1000, 800};

std::vector<FocalPlanePoint> grid(int side, const std::function<double(double, double)>& value, double error) {
  std::vector<FocalPlanePoint> points;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double x = 1000.0 * (i + 0.5) / side;
      const double y = 800.0 * (j + 0.5) / side;
      points.push_back({x, y, {value(x, y), error}});
    }
  return points;
}

double quadratic(double x, double y) {
  return 50.0 + 0.01 * x - 0.02 * y + 1e-5 * x * x + 2e-5 * x * y - 3e-6 * y * y;
}

TEST(FocalPlaneSurface, FindsAQuadraticExactly) {
  const FocalPlaneSurface surface(grid(3, quadratic, 0.5), kDetector);
  EXPECT_EQ(surface.degree(), 2);
  for (const double x : {0.0, 333.0, 999.0})
    for (const double y : {0.0, 500.0, 799.0}) EXPECT_NEAR(surface(x, y).value, quadratic(x, y), 1e-9);
}

TEST(FocalPlaneSurface, ErrorsCoverWhatTheyShould) {
  constexpr double kSigma = 0.5;
  const RandomStream stream = make_stream(7, StreamId{1}, 0, 0);
  std::uint64_t drawn = 0;
  const auto normal = [&] { return kSigma * normal_at_step(stream, {.step = drawn++}); };
  int inside = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const FocalPlaneSurface surface(grid(
                                        5, [&](double x, double y) { return quadratic(x, y) + normal(); }, kSigma),
                                    kDetector);
    const FocalPlaneValue at = surface(700.0, 200.0);
    inside += std::abs(at.value - quadratic(700.0, 200.0)) < at.error ? 1 : 0;
  }
  // The errors are never made smaller than those of the points but sometimes larger, so a little above 68.3 %.
  const double share = static_cast<double>(inside) / kTrials;
  std::printf("%.3f within one standard error\n", share);
  EXPECT_GT(share, 0.683 - 3.0 * 0.0104);
  EXPECT_LT(share, 0.78);
}

TEST(FocalPlaneSurface, ScatterThatItCannotFollowIsInTheError) {
  const auto wave = [](double x, double y) { return 50.0 + 5.0 * std::sin(0.05 * x) * std::cos(0.04 * y); };
  const FocalPlaneSurface surface(grid(6, wave, 0.01), kDetector);
  EXPECT_GT(surface(500.0, 400.0).error, 0.1);
}

TEST(FocalPlaneSurface, TakesFewPointsAsTheyCome) {
  EXPECT_EQ(FocalPlaneSurface({}, kDetector).degree(), -1);
  EXPECT_TRUE(std::isnan(FocalPlaneSurface({}, kDetector)(1.0, 1.0).value));
  const std::vector<FocalPlanePoint> one{{100.0, 100.0, {42.0, 1.0}}};
  EXPECT_DOUBLE_EQ(FocalPlaneSurface(one, kDetector)(900.0, 700.0).value, 42.0);
  const std::vector<FocalPlanePoint> unknown{{100.0, 100.0, {}}, {200.0, 100.0, {7.0, 1.0}}};
  EXPECT_DOUBLE_EQ(FocalPlaneSurface(unknown, kDetector)(0.0, 0.0).value, 7.0);
  std::vector<FocalPlanePoint> column;
  for (int i = 0; i < 5; ++i) column.push_back({500.0, 100.0 * i, {1.0 + i, 0.1}});
  EXPECT_NEAR(FocalPlaneSurface(column, kDetector)(500.0, 250.0).value, 3.5, 1e-9);
}

TargetMetrics target(double mag, double noise) {
  TargetMetrics t;
  t.mag = mag;
  t.nsr_1h_ppm = noise;
  t.predicted.bin_within = 3.0 * noise;
  t.nsr_1h_within_measured.value = 1.02 * 3.0 * noise;
  t.spr_tot = 1e-4;
  t.causes.residual = 2e-3;
  t.flux_in = t.flux_expected = t.flux_measured = 1e5;
  t.exposures = 10;
  t.enclosed_fraction = 0.9;
  return t;
}

TEST(SubFieldMetrics, TakesTheNoiseToTheReferenceMagnitude) {
  std::vector<TargetMetrics> targets;
  for (int i = 0; i < 40; ++i) {
    const double mag = 10.2 + 0.05 * i;
    targets.push_back(target(mag, 50.0 * std::pow(10.0, 0.25 * (mag - 11.0))));
  }
  targets.push_back(target(14.0, 1e6));  // too far
  const SubFieldMetrics metrics = sub_field_metrics({100, 200, 51, 41}, targets, 11.0, {});
  EXPECT_EQ(metrics.targets, 41);
  EXPECT_EQ(metrics.x, 125.0);
  EXPECT_EQ(metrics.y, 220.0);
  EXPECT_NEAR(metrics.nsr_predicted.value, 50.0, 1e-9);
  EXPECT_NEAR(metrics.nsr_measured.value, 51.0, 1e-9);
  EXPECT_NEAR(metrics.spr.value, 1e-4, 1e-12);
  EXPECT_NEAR(metrics.recovery.value, 2e-3, 1e-12);
}

TEST(SubFieldMetrics, KnowsNothingWithoutTargets) {
  const SubFieldMetrics metrics = sub_field_metrics({0, 0, 10, 10}, {}, 11.0, {});
  EXPECT_EQ(metrics.clean, 0);
  EXPECT_TRUE(std::isnan(metrics.nsr_predicted.value));
  EXPECT_TRUE(std::isnan(metrics.spr.value));
}

}  // namespace
}  // namespace astroid
