// The image as a polynomial in the attitude against the rendering of every star at every step, in a crowd.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/aperture_fluxes.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 96;
constexpr std::size_t kStars = 1300;  // 14 in 100 px, as in the field of Gutierrez-Canales et al.

StarCatalogue crowd() {
  const RandomStream stream = make_stream(5, StreamId{77}, 0, 0);
  std::vector<test::LabStar> stars;
  for (std::size_t i = 0; i < kStars; ++i) {
    const auto u = [&](std::uint32_t axis) { return uniform_at_step(stream, {.step = i, .axis = axis}); };
    // Counts growing as 10^(0.3 m): from 4000 e- at magnitude 15 to 9e5 e- in the brightest pixel.
    stars.push_back({kSide * u(0) - 0.5, kSide * u(1) - 0.5, std::min(1.5e6, 4000.0 * std::pow(u(2), -0.75 / 0.57))});
  }
  return test::lab_catalogue(stars);
}

Mission mission() {
  Mission mission = test::plato_mission(kSide, kSide);
  mission.simulation.exposures = 400;
  return mission;
}

std::shared_ptr<Plan> plan_with(const Scene& scene, JitterTreatment treatment) {
  auto plan = std::make_shared<Plan>(make_plan(scene));
  EXPECT_EQ(plan->knobs.jitter, JitterTreatment::kPolynomial);  // as planned for a crowd
  plan->knobs.jitter = treatment;
  return plan;
}

TEST(MovingImage, KeepsEveryFluxOfACrowdWithinTheAccuracy) {
  const auto scene = std::make_shared<const Scene>(mission(), crowd());
  const Simulator recalled(scene, plan_with(*scene, JitterTreatment::kPolynomial), 0);
  const Simulator rendered(scene, plan_with(*scene, JitterTreatment::kSubSteps), 0);
  ExposureState a = recalled.make_state();
  ExposureState b = rendered.make_state();
  double worst = 0.0;      // of the tolerance
  double worst_ppm = 0.0;  // of the flux, of stars and background in the aperture
  double sum = 0.0;
  int count = 0;
  double farthest = 0.0;
  for (const std::int64_t exposure : {0, 1, 17, 101, 200, 333, 399}) {
    recalled.expect(exposure, a);
    rendered.expect(exposure, b);
    farthest = std::max({farthest, std::abs(a.attitude.mean.yaw), std::abs(a.attitude.mean.pitch)});
    const std::vector<double> fast = test::aperture_fluxes(*scene, a);
    const std::vector<double> slow = test::aperture_fluxes(*scene, b);
    for (std::size_t t = 0; t < fast.size(); ++t) {
      const double error = std::abs(fast[t] - slow[t]);
      worst = std::max(worst, error / scene->summary().flux_tolerance(slow[t]));
      worst_ppm = std::max(worst_ppm, 1e6 * error / slow[t]);
      sum += error * error / (slow[t] * slow[t]);
      ++count;
    }
  }
  std::printf(
      "%zu terms, attitudes up to %.4f arcsec: largest error %.4f ppm (%.3f of what is allowed), rms %.4f ppm\n",
      recalled.plan().knobs.polynomial.terms.size(), farthest, worst_ppm, worst, 1e6 * std::sqrt(sum / count));
  EXPECT_LT(worst, 0.3);  // the share of jitter
  EXPECT_GT(worst_ppm, 0.0);
}

TEST(MovingImage, HoldsUpToTheBordersOfACellAndBeyond) {
  // Attitudes are put at the corners of cells, where the polynomial is at its worst.
  const auto scene = std::make_shared<const Scene>(mission(), crowd());
  const auto plan = plan_with(*scene, JitterTreatment::kPolynomial);
  const Attitude scale = plan->knobs.polynomial.scale;
  auto series = std::make_shared<AttitudeSeries>();
  std::vector<Attitude> places;
  for (const double yaw : {-0.999, 0.0, 0.999, 1.001, 2.7})
    for (const double pitch : {-0.999, 0.999, -1.001})
      places.push_back({yaw * scale.yaw, pitch * scale.pitch, 0.9 * scale.roll});
  for (const Attitude& a : places) {
    series->moments.push_back({.mean = a, .covariance = {}});
    const std::vector<float> weights = exposure_weights(plan->knobs.polynomial, std::array{a});
    series->weights.insert(series->weights.end(), weights.begin(), weights.end());
    series->farthest = {3.0 * scale.yaw, 3.0 * scale.pitch, scale.roll};
  }
  const Simulator recalled(scene, plan, 0, series);
  const Simulator rendered(scene, plan_with(*scene, JitterTreatment::kShift), 0, series);
  ExposureState a = recalled.make_state();
  ExposureState b = rendered.make_state();
  double worst = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    recalled.expect(static_cast<std::int64_t>(k), a);
    rendered.expect(static_cast<std::int64_t>(k), b);
    const std::vector<double> fast = test::aperture_fluxes(*scene, a);
    const std::vector<double> slow = test::aperture_fluxes(*scene, b);
    for (std::size_t t = 0; t < fast.size(); ++t)
      worst = std::max(worst, std::abs(fast[t] - slow[t]) / scene->summary().flux_tolerance(slow[t]));
  }
  std::printf("at the corners of cells: %.3f of what is allowed\n", worst);
  EXPECT_LT(worst, 0.3);
}

TEST(MovingImage, IsTheSameInAWindow) {
  Mission windows = mission();
  windows.ccd.window = 9;
  const auto whole_scene = std::make_shared<const Scene>(mission(), crowd());
  const auto window_scene = std::make_shared<const Scene>(windows, crowd());
  const Simulator whole(whole_scene, plan_with(*whole_scene, JitterTreatment::kPolynomial), 0);
  const Simulator part(window_scene, plan_with(*window_scene, JitterTreatment::kPolynomial), 0);
  ExposureState a = whole.make_state();
  ExposureState b = part.make_state();
  whole.expect(12, a);
  part.expect(12, b);
  const PixelLayout& layout = b.expected.whole().layout();  // the windows, and what may bloom into them
  for (std::size_t r = 0; r < layout.regions().size(); ++r) {
    const Rectangle& area = layout.regions()[r];
    for (int y = area.y0; y < area.y1(); ++y)
      for (int x = area.x0; x < area.x1(); ++x)
        ASSERT_EQ(b.expected.whole().view(r).at(x, y), a.expected.whole().view(0).at(x, y)) << x << ' ' << y;
  }
}

TEST(MovingImage, IsTheSameUnderAnObserver) {
  const auto scene = std::make_shared<const Scene>(mission(), crowd());
  const Simulator simulator(scene, plan_with(*scene, JitterTreatment::kPolynomial), 0);
  ExposureState plain = simulator.make_state();
  ExposureState observed = simulator.make_state();
  simulator.simulate(3, plain);
  int steps = 0;
  simulator.simulate(3, observed, [&steps](const EffectSpec&, const ExposureState&) { ++steps; });
  EXPECT_GT(steps, 8);
  EXPECT_TRUE(std::ranges::equal(plain.frame.pixels.pixels(), observed.frame.pixels.pixels()));
}

}  // namespace
}  // namespace astroid
