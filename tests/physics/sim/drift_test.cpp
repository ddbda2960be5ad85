// A field that drifts: the light in a fixed mask follows the exact curve, without lines where the numerics change cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 24;
constexpr double kSigma = 0.6;
constexpr Rectangle kMask{10, 10, 4, 4};

/// One star in the middle of a mask, and others around it.
StarCatalogue field(std::size_t others) {
  const RandomStream stream = make_stream(9, StreamId{77}, 0, 0);
  std::vector<test::LabStar> stars{{11.37, 11.71, 4e5}};
  for (std::size_t i = 0; i < others; ++i) {
    const auto u = [&](std::uint32_t axis) { return uniform_at_step(stream, {.step = i, .axis = axis}); };
    stars.push_back({kSide * u(0) - 0.5, kSide * u(1) - 0.5, 3000.0 / (0.03 + u(2))});
  }
  return test::lab_catalogue(stars);
}

/// 1.3 px in 90 days, the worst of PLATO, mostly along x.
Mission drifting_mission() {
  Mission mission = test::bare_mission(kSide, kSide);
  mission.simulation.cycle = Seconds(600.0);
  mission.simulation.exposures = 90 * 144;
  mission.satellite.drift.yaw_rate = Arcseconds(1.25 * 15.0 / 90.0);
  mission.satellite.drift.pitch_rate = Arcseconds(0.35 * 15.0 / 90.0);
  return mission;
}

double mask_sum(const ExposureState& state) {
  double sum = 0.0;
  for (int y = kMask.y0; y < kMask.y1(); ++y)
    for (int x = kMask.x0; x < kMask.x1(); ++x) sum += state.expected.whole().view(0).at(x, y);
  return sum;
}

/// Light of every star in the mask, by the error function, where the attitude is that of the middle of an exposure.
double exact_sum(const Scene& scene, double seconds) {
  const double days = seconds / 86400.0;
  const DriftSettings& drift = scene.mission().satellite.drift;
  const Attitude attitude{drift.yaw_rate.value() * days, drift.pitch_rate.value() * days, 0.0};
  const auto part = [](double low, double high, double centre) {
    const double scale = 1.0 / (std::sqrt(2.0) * kSigma);
    return 0.5 * (std::erf((high - centre) * scale) - std::erf((low - centre) * scale));
  };
  double sum = 0.0;
  for (const SceneStar& star : scene.stars()) {
    const PixelShift shift = displacement(star.motion, attitude);
    sum += star.electrons * part(kMask.x0 - 0.5, kMask.x1() - 0.5, star.position.x + shift.dx) *
           part(kMask.y0 - 0.5, kMask.y1() - 0.5, star.position.y + shift.dy);
  }
  return sum;
}

/// The highest amplitude of a series but for its mean and its line, over all frequencies up to the highest.
double highest_line(std::vector<double> x) {
  const auto n = static_cast<double>(x.size());
  double mean = 0.0;
  for (const double v : x) mean += v / n;
  for (double& v : x) v -= mean;
  double highest = 0.0;
  for (std::size_t f = 1; f < x.size() / 2; ++f) {
    const double turn = 2.0 * std::acos(-1.0) * static_cast<double>(f) / n;
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    double phase_c = 1.0;
    double phase_s = 0.0;
    double re = 0.0;
    double im = 0.0;
    for (const double v : x) {
      re += v * phase_c;
      im += v * phase_s;
      const double next = phase_c * c - phase_s * s;
      phase_s = phase_s * c + phase_c * s;
      phase_c = next;
    }
    highest = std::max(highest, 2.0 * std::hypot(re, im) / n);
  }
  return highest;
}

class DriftingStar : public testing::TestWithParam<std::size_t> {};

TEST_P(DriftingStar, ShowsNoLineAboveOnePpm) {
  const Mission mission = drifting_mission();
  const auto scene = std::make_shared<const Scene>(mission, field(GetParam()));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  EXPECT_TRUE(plan->runs("drift"));
  EXPECT_EQ(plan->knobs.jitter, GetParam() > 0 ? JitterTreatment::kPolynomial : JitterTreatment::kShift);
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  std::vector<double> residual;
  double lowest = 1e300;
  double highest = 0.0;
  double worst = 0.0;
  for (std::int64_t k = 0; k < mission.simulation.exposures; ++k) {
    simulator.expect(k, state);
    const double exact = exact_sum(*scene, static_cast<double>(k) * 600.0 + 10.5);
    residual.push_back(1e6 * (mask_sum(state) / exact - 1.0));
    worst = std::max(worst, std::abs(residual.back()));
    lowest = std::min(lowest, exact);
    highest = std::max(highest, exact);
  }
  const double line = highest_line(residual);
  std::printf("%zu stars, %s, %zu terms, cells of +-%.3g px: flux changes by %.3g %%, residual up to %.3g ppm, highest "
              "line %.3g ppm\n",
              scene->stars().size(), std::string(to_string(plan->knobs.jitter)).c_str(),
              plan->knobs.polynomial.terms.size(), plan->knobs.polynomial.scale.yaw / 15.0,
              100.0 * (highest / lowest - 1.0), worst, line);
  EXPECT_GT(highest / lowest, 1.05);
  EXPECT_LT(line, 1.0);
  EXPECT_LT(worst, 1.0);
}

INSTANTIATE_TEST_SUITE_P(AloneAndInACrowd, DriftingStar, testing::Values(0U, 60U));

TEST(DriftWithJitter, FollowsItsCells) {
  Mission mission = drifting_mission();
  mission.simulation.cycle = Seconds(25.0);
  mission.simulation.exposures = 60000;
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(0.038);
  const auto scene = std::make_shared<const Scene>(mission, field(60));
  auto plan = std::make_shared<Plan>(make_plan(*scene));
  ASSERT_EQ(plan->knobs.jitter, JitterTreatment::kPolynomial);
  auto stepped = std::make_shared<Plan>(*plan);
  stepped->knobs.jitter = JitterTreatment::kSubSteps;
  const Simulator recalled(scene, plan, 0);
  const Simulator rendered(scene, stepped, 0);
  ExposureState a = recalled.make_state();
  ExposureState b = rendered.make_state();
  double worst = 0.0;
  for (std::int64_t k = 0; k < mission.simulation.exposures; k += 97) {
    recalled.expect(k, a);
    rendered.expect(k, b);
    worst = std::max(worst, 1e6 * std::abs(mask_sum(a) / mask_sum(b) - 1.0));
  }
  std::printf("%zu terms, cells of +-%.3g px: jitter and drift by maps differ from sub-steps by %.3g ppm\n",
              plan->knobs.polynomial.terms.size(), plan->knobs.polynomial.scale.yaw / 15.0, worst);
  EXPECT_LT(worst, 0.3);
}

TEST(Drift, WithoutStrengthIsNoDriftAtAll) {
  Mission still = drifting_mission();
  still.satellite.drift = {};
  still.satellite.repointing = {};
  const Scene scene(still, field(3));
  const Plan plan = make_plan(scene);
  EXPECT_FALSE(plan.runs("drift"));
  EXPECT_FALSE(plan.runs("re-pointing"));
  EXPECT_FALSE(plan.runs("aberration"));
  EXPECT_TRUE(plan.still);
}

}  // namespace
}  // namespace astroid
