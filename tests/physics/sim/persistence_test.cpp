// Persistence: charge is conserved, what is released follows the time constants, and images of the past are those that
// the earlier exposures had.
#include "astroid/sim/persistence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr Seconds kCycle{25.0};
constexpr Seconds kExposure{21.0};
constexpr double kNothing = 1e-15;

// Shares released by charge 1, by the sum over exponentials, with what is trapped again (at most the square).
double released_by_hand(const PersistenceSettings& s, int n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.fraction.size(); ++i)
    sum += s.fraction[i] * std::exp(-(n * 25.0 - 21.0) / s.time[i]) * (1.0 - std::exp(-21.0 / s.time[i]));
  return sum;
}

TEST(PersistenceKernel, ReleasesExponentially) {
  const PersistenceSettings faint{.fraction = {3e-9, 1e-9}, .time = {60.0, 900.0}};
  const PersistenceKernel kernel(faint, kCycle, kExposure, 1e-16);
  EXPECT_DOUBLE_EQ(kernel.taken(), 4e-9);
  for (const int n : {1, 2, 7, 40})
    EXPECT_NEAR((kernel.released_within(n) - kernel.released_within(n - 1)) / released_by_hand(faint, n), 1.0, 1e-6);
}

TEST(PersistenceKernel, GivesBackWhatItTakesWhereNoTimeIsLost) {
  // Taken of 1: f. Released: R = sum of all later ones, of which the share f is taken again: R = f (1 + R).
  const PersistenceSettings traps{.fraction = {0.05, 0.02}, .time = {60.0, 300.0}};
  const PersistenceKernel kernel(traps, kExposure, kExposure, kNothing);
  EXPECT_NEAR(kernel.released_within(kernel.reach()), 0.07 / 0.93, 1e-12);
  // Shown of 1 in all: nothing is lost.
  EXPECT_NEAR((1.0 - kernel.taken()) * (1.0 + kernel.released_within(kernel.reach())), 1.0, 1e-12);
}

TEST(PersistenceKernel, OfNoTrapsIsNothing) {
  for (const PersistenceSettings& none :
       {PersistenceSettings{}, PersistenceSettings{.fraction = {0.0}, .time = {100.0}}}) {
    const PersistenceKernel kernel(none, kCycle, kExposure, kNothing);
    EXPECT_EQ(kernel.taken(), 0.0);
    EXPECT_EQ(kernel.reach(), 0);
    EXPECT_TRUE(past_charge(kernel, 100, 1, 0.0).empty());
  }
}

TEST(PersistenceKernel, OfExtremeTimesIsFinite) {
  for (const double time : {1e-6, 1e6}) {
    const PersistenceKernel kernel({.fraction = {0.1}, .time = {time}}, kCycle, kExposure, 1e-8);
    EXPECT_TRUE(std::isfinite(kernel.released_within(kernel.reach())));
    EXPECT_GE(kernel.released_within(kernel.reach()), 0.0);
    EXPECT_LE(kernel.released_within(kernel.reach()), 0.1 / 0.9);
  }
}

TEST(PastCharge, CountsEveryExposureOnceWhateverStandsForIt) {
  const PersistenceKernel kernel({.fraction = {0.01}, .time = {200.0}}, kCycle, kExposure, 1e-10);
  for (const std::int64_t block : {0, 1, 8, 64})
    for (const std::int64_t exposure : {0, 1, 5, 63, 64, 65, 1000}) {
      double sum = 0.0;
      for (const PastCharge& past : past_charge(kernel, exposure, block, 0.0)) {
        EXPECT_LT(past.exposure, exposure);
        EXPECT_GT(past.share, 0.0);
        if (block > 0) {
          EXPECT_EQ(past.exposure % block, 0);
        }
        sum += past.share;
      }
      EXPECT_NEAR(sum, kernel.released_within(exposure), 1e-15) << block << ", " << exposure;
    }
}

TEST(PastCharge, BlocksEndWithTheirQuarter) {
  const PersistenceKernel kernel({.fraction = {0.01}, .time = {200.0}}, kCycle, kExposure, 1e-10);
  std::vector<std::int64_t> stands;
  for (const PastCharge& past : past_charge(kernel, 40, 16, 37.5)) stands.push_back(past.exposure);
  EXPECT_EQ(stands, (std::vector<std::int64_t>{38, 32, 16, 0}));
}

Mission cmos_mission() {
  Mission mission = test::bare_mission(48, 40);
  mission.simulation.type = DetectorType::kCmos;
  mission.simulation.exposures = 60;
  mission.field.sky_background = ElectronsPerSecond(30.0);
  mission.cmos.persistence = {.fraction = {0.004, 0.002}, .time = {60.0, 400.0}};
  return mission;
}

struct Planned {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};
Planned planned(const Mission& mission) {
  const std::vector<test::LabStar> stars{{20.2, 19.7, 3e6}, {31.4, 11.2, 2e5}, {9.9, 30.3, 4e4}};
  Planned p;
  p.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  p.plan = std::make_shared<const Plan>(make_plan(*p.scene));
  return p;
}

std::vector<double> expected_of(const Simulator& simulator, std::int64_t exposure) {
  ExposureState state = simulator.make_state();
  simulator.expect(exposure, state);
  const auto pixels = std::as_const(state.expected).whole().pixels();
  return {pixels.begin(), pixels.end()};
}

TEST(Persistence, OfASceneThatRestsIsTheImageTimesANumber) {
  Mission mission = cmos_mission();
  mission.ccd.full_well = Electrons(2e5);  // the brightest star has pixels beyond it
  Mission clean = mission;
  clean.cmos.persistence = {};
  const Planned p = planned(mission);
  const Planned c = planned(clean);
  ASSERT_TRUE(p.plan->runs("persistence"));
  ASSERT_FALSE(c.plan->runs("persistence"));
  EXPECT_EQ(p.plan->knobs.memory_block, 0);
  const Simulator with(p.scene, p.plan, 0);
  const Simulator without(c.scene, c.plan, 0);
  const PersistenceKernel kernel(mission.cmos.persistence, kCycle, kExposure, 1e-8);
  const std::vector<double> light = expected_of(without, 0);
  int full = 0;
  for (const std::int64_t exposure : {0, 1, 2, 20, 59}) {
    const std::vector<double> seen = expected_of(with, exposure);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double held = light[i] + kernel.released_within(exposure) * std::min(light[i], 2e5);
      const double shown = held - kernel.taken() * std::min(held, 2e5);
      full += light[i] > 2e5;
      ASSERT_NEAR(seen[i] / shown, 1.0, 1e-8) << exposure << ", " << i;  // the past is kept in single precision
    }
  }
  EXPECT_GT(full, 0);
}

TEST(Persistence, OfASceneThatMovesIsThatOfEveryEarlierExposure) {
  Mission mission = cmos_mission();
  mission.satellite.drift.yaw_rate = Arcseconds(4e4);  // 0.77 px from exposure to exposure
  Mission clean = mission;
  clean.cmos.persistence = {};
  Planned p = planned(mission);
  const Planned c = planned(clean);
  ASSERT_TRUE(p.plan->runs("persistence"));
  auto exact = std::make_shared<Plan>(*p.plan);
  exact->knobs.memory_block = 1;
  const Simulator with(p.scene, exact, 0);
  const Simulator without(c.scene, c.plan, 0);
  const PersistenceKernel kernel(mission.cmos.persistence, kCycle, kExposure, 1e-8);
  constexpr std::int64_t kLast = 9;
  std::vector<double> sum = expected_of(without, kLast);
  for (std::int64_t j = 0; j < kLast; ++j) {
    const double share = kernel.released_within(kLast - j) - kernel.released_within(kLast - 1 - j);
    const std::vector<double> light = expected_of(without, j);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * light[i];
  }
  const std::vector<double> seen = expected_of(with, kLast);
  for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_NEAR(seen[i] / ((1.0 - kernel.taken()) * sum[i]), 1.0, 1e-8) << i;
}

TEST(Persistence, BlocksErrByNoMoreThanThePlanSays) {
  Mission mission = cmos_mission();
  mission.satellite.drift.yaw_rate = Arcseconds(40.0);
  mission.satellite.jitter = {.model = JitterModel::kRedNoise,
                              .yaw = Arcseconds(0.04),
                              .pitch = Arcseconds(0.04),
                              .roll = Arcseconds(0.0),
                              .file = {}};
  const Planned p = planned(mission);
  EXPECT_GT(p.plan->knobs.memory_block, 1);
  auto exact = std::make_shared<Plan>(*p.plan);
  exact->knobs.memory_block = 1;
  const Simulator blocks(p.scene, p.plan, 0);
  const Simulator all(p.scene, exact, 0);
  double worst = 0.0;
  for (const std::int64_t exposure : {13, 40, 59}) {
    const std::vector<double> a = expected_of(blocks, exposure);
    const std::vector<double> b = expected_of(all, exposure);
    for (const SceneStar& star : p.scene->stars()) {
      double difference = 0.0;
      for (int y = -2; y < 4; ++y)
        for (int x = -2; x < 4; ++x) {
          const auto i = static_cast<std::size_t>((static_cast<int>(star.position.y) + y) * 48 +
                                                  static_cast<int>(star.position.x) + x);
          difference += a[i] - b[i];
        }
      worst = std::max(worst, std::fabs(difference) / p.scene->summary().flux_tolerance(star.electrons));
    }
  }
  std::printf("blocks of %lld exposures move a flux by at most %.2g of its tolerance\n",
              static_cast<long long>(p.plan->knobs.memory_block), worst);
  EXPECT_LT(worst, 0.3);
}

// Poisson charge that is taken and released electron by electron is Poisson again: the noise is that of the mean.
TEST(Persistence, LeavesPoissonNoise) {
  Mission mission = test::bare_mission(200, 200);
  mission.simulation.type = DetectorType::kCmos;
  mission.field.sky_background = ElectronsPerSecond(50.0);
  mission.cmos.persistence = {.fraction = {0.1}, .time = {60.0}};
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{100.0, 100.0, 1e-6}}));
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ASSERT_TRUE(simulator.plan().runs("persistence"));
  const double mean = expected_of(simulator, 3)[0];
  ExposureState state = simulator.make_state();
  simulator.simulate(3, state);
  double sum = 0.0;
  double squares = 0.0;
  const auto pixels = std::as_const(state.frame.pixels).pixels();
  for (const float count : pixels) {
    sum += static_cast<double>(count) - mean;
    squares += (static_cast<double>(count) - mean) * (static_cast<double>(count) - mean);
  }
  const auto n = static_cast<double>(pixels.size());
  EXPECT_NEAR(sum / n, 0.0, 4.0 * std::sqrt(mean / n));
  EXPECT_NEAR(squares / n / mean, 1.0, 4.0 * std::sqrt(2.0 / n));
}

}  // namespace
}  // namespace astroid
