// A field that drifts: the light in a fixed mask follows the exact curve, without lines where the numerics change
// cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
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

/// Light in the mask of a star at a place, by the error function.
double exact_light(double electrons, PixelPosition p) {
  const auto part = [](double low, double high, double centre) {
    const double scale = 1.0 / (std::sqrt(2.0) * kSigma);
    return 0.5 * (std::erf((high - centre) * scale) - std::erf((low - centre) * scale));
  };
  return electrons * part(kMask.x0 - 0.5, kMask.x1() - 0.5, p.x) * part(kMask.y0 - 0.5, kMask.y1() - 0.5, p.y);
}

/// Light of every star in the mask, where the attitude is that of the middle of an exposure.
double exact_sum(const Scene& scene, double seconds) {
  const double days = seconds / 86400.0;
  const DriftSettings& drift = scene.mission().satellite.drift;
  const Attitude attitude{drift.yaw_rate.value() * days, drift.pitch_rate.value() * days, 0.0};
  double sum = 0.0;
  for (const SceneStar& star : scene.stars()) {
    const PixelShift shift = displacement(star.motion, attitude);
    sum += exact_light(star.electrons, {star.position.x + shift.dx, star.position.y + shift.dy});
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
  std::printf(
      "%zu stars, %s, %zu terms, cells of +-%.3g px: flux changes by %.3g %%, residual up to %.3g ppm, highest "
      "line %.3g ppm\n",
      scene->stars().size(), std::string(to_string(plan->knobs.jitter)).c_str(), plan->knobs.polynomial.terms.size(),
      plan->knobs.polynomial.scale.yaw / 15.0, 100.0 * (highest / lowest - 1.0), worst, line);
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

/// Just below the threshold of an effect of pointing, the plan of just above moves no flux by more than its tolerance.
void expect_harmless_below_threshold(const std::string& effect, const std::function<void(Mission&, double)>& set,
                                     double high) {
  const auto mission_of = [&](double strength) {
    Mission mission = test::bare_mission(kSide, kSide);
    mission.simulation.exposures = 200;
    mission.ccd.axis_x = 1000.0;
    set(mission, strength);
    return mission;
  };
  double low = 0.0;
  while (high - low > 0.01 * high) {
    const double middle = 0.5 * (low + high);
    const Scene scene(mission_of(middle), field(0));
    (make_plan(scene).runs(effect) ? high : low) = middle;
  }
  ASSERT_GT(low, 0.0);
  const auto off = std::make_shared<const Scene>(mission_of(low), field(0));
  const auto on = std::make_shared<const Scene>(mission_of(1.02 * high), field(0));
  const Simulator still(off, std::make_shared<const Plan>(make_plan(*off)), 0);
  const Simulator moved(on, std::make_shared<const Plan>(make_plan(*on)), 0);
  ASSERT_FALSE(still.plan().runs(effect));
  ASSERT_TRUE(moved.plan().runs(effect));
  ExposureState a = still.make_state();
  ExposureState b = moved.make_state();
  double worst = 0.0;
  for (std::int64_t k = 0; k < 200; k += 7) {
    still.expect(k, a);
    moved.expect(k, b);
    const double tolerance = off->summary().flux_tolerance(off->stars()[0].electrons);
    worst = std::max(worst, std::abs(mask_sum(a) - mask_sum(b)) / tolerance);
  }
  std::printf("%s at %.3g: moves a flux by at most %.2g of its tolerance\n", effect.c_str(), low, worst);
  EXPECT_LE(worst, 1.05);  // the motion is up to 3 % more than that of the threshold
  EXPECT_GT(worst, 0.0);
}

TEST(SkippedPointing, BelowItsThresholdIsHarmless) {
  expect_harmless_below_threshold(
      "drift", [](Mission& m, double v) { m.satellite.drift.yaw_rate = Arcseconds(v); }, 100.0);
  expect_harmless_below_threshold(
      "re-pointing",
      [](Mission& m, double v) {
        m.satellite.quarter_days = 1000.0 / 86400.0;
        m.satellite.repointing.yaw = Arcseconds(v);
      },
      10.0);
  expect_harmless_below_threshold(
      "aberration",
      [](Mission& m, double v) {
        m.ccd.axis_x = 11.4 + 1000.0 * v;  // the farther from the boresight, the more a star moves
        m.ccd.axis_y = 11.7;
        m.satellite.aberration = true;
      },
      1.0);
}

TEST(Aberration, MovesTheImageAsItsJacobianSays) {
  Mission mission = drifting_mission();
  mission.satellite.drift = {};
  mission.satellite.aberration = true;
  mission.ccd.axis_x = 2000.0;
  const auto scene = std::make_shared<const Scene>(mission, field(0));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  ASSERT_TRUE(plan->runs("aberration"));
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  const SceneStar& star = scene->stars()[0];
  const double start = mission.simulation.start_mjd;
  double worst = 0.0;
  double farthest = 0.0;
  double changed = 0.0;
  const double unmoved = exact_light(star.electrons, star.position);
  for (std::int64_t k = 0; k < mission.simulation.exposures; k += 101) {
    simulator.expect(k, state);
    const Velocity a = spacecraft_velocity(start);
    const Velocity b = spacecraft_velocity(start + (static_cast<double>(k) * 600.0 + 10.5) / 86400.0);
    const PixelShift shift = star.aberration.displacement({b[0] - a[0], b[1] - a[1], b[2] - a[2]});
    const double exact = exact_light(star.electrons, {star.position.x + shift.dx, star.position.y + shift.dy});
    farthest = std::max(farthest, std::hypot(shift.dx, shift.dy));
    changed = std::max(changed, std::abs(exact / unmoved - 1.0));
    worst = std::max(worst, std::abs(mask_sum(state) - exact) / scene->summary().flux_tolerance(star.electrons));
  }
  std::printf("aberration moves the star by up to %.4f px and its flux by %.3g ppm, to %.2g of the tolerance\n",
              farthest, 1e6 * changed, worst);
  EXPECT_GT(farthest, 0.02);
  EXPECT_GT(changed, 1e-4);
  EXPECT_LT(worst, 0.3);  // its share of the tolerance, by epochs
}

}  // namespace
}  // namespace astroid
