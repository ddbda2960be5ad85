// Quarters of a mission that turns between them: stars elsewhere, time goes on, noise anew, the detector the same.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "astroid/core/throughput.hpp"
#include "astroid/sim/optics.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

Mission mission_of(int quarter) {
  Mission mission = test::bare_mission(120, 120);
  mission.satellite.repointing.turn = Degrees(90.0);
  mission.simulation.quarter = quarter;
  return mission;
}

TEST(Quarter, TurnsEveryStarAboutTheAxis) {
  const SkyProjection first = make_projection(mission_of(0));
  const PixelPosition axis = first.axis_pixel();
  const PixelPosition place{axis.x + 40.0, axis.y + 10.0};
  const SkyPosition star = first.to_sky(place);
  double distance = 0.0;
  for (int quarter = 0; quarter < 5; ++quarter) {
    const auto p = make_projection(mission_of(quarter)).to_pixel(star);
    ASSERT_TRUE(p.has_value());
    const double dx = p->x - axis.x;
    const double dy = p->y - axis.y;
    EXPECT_NEAR(std::hypot(dx, dy), std::hypot(40.0, 10.0), 1e-6);
    // A quarter of a turn, in one sense: the product with the first place is 0, -1, 0, 1 of its square.
    constexpr double kCosines[] = {1.0, 0.0, -1.0, 0.0, 1.0};
    EXPECT_NEAR((dx * 40.0 + dy * 10.0) / 1700.0, kCosines[quarter], 1e-6) << quarter;
    distance = dx * 10.0 - dy * 40.0;
  }
  EXPECT_NEAR(distance, 0.0, 1e-3);
}

TEST(Quarter, KeepsTheDetectorAndDrawsNoiseAnew) {
  const auto exposure_of = [](int quarter) {
    Mission mission = mission_of(quarter);
    mission.satellite.repointing.turn = Degrees(0.0);
    mission.field.sky_background = ElectronsPerSecond(50.0);
    mission.ccd.prnu = 0.02;
    const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{60.0, 60.0, 1e4}}));
    const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
    ExposureState state = simulator.make_state();
    simulator.simulate(0, state);
    ExposureState noiseless = simulator.make_state();
    simulator.expect(0, noiseless);
    return std::pair(std::move(state), std::move(noiseless));
  };
  const auto [noise0, mean0] = exposure_of(0);
  const auto [noise1, mean1] = exposure_of(1);
  double covariance = 0.0;
  double variance = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < noise0.frame.pixels.size(); ++i, ++n) {
    const double mean = mean0.expected.whole().pixels()[i];
    ASSERT_EQ(mean, mean1.expected.whole().pixels()[i]);
    const double a = static_cast<double>(noise0.frame.pixels.pixels()[i]) - mean;
    const double b = static_cast<double>(noise1.frame.pixels.pixels()[i]) - mean;
    covariance += a * b;
    variance += a * a;
  }
  EXPECT_LT(std::fabs(covariance / variance), 4.0 / std::sqrt(static_cast<double>(n)));
}

TEST(Quarter, TimeGoesOn) {
  Mission mission = mission_of(3);
  mission.telescope.throughput.end_of_life = 0.5;
  Mission later = mission_of(0);
  later.telescope.throughput = mission.telescope.throughput;
  EXPECT_EQ(throughput_at(mission, Seconds(0.0)), throughput_at(later, Seconds(3.0 * 90.0 * 86400.0)));
  const Scene scene(mission, test::lab_catalogue({{60.0, 60.0, 1e4}}));
  EXPECT_EQ(scene.mission_time(0).value(), 3.0 * 90.0 * 86400.0 + 10.5);
  EXPECT_EQ(scene.mid_time(0).value(), 10.5);
  EXPECT_EQ(scene.mission_number(2), 3 * 311040 + 2);
}

TEST(Quarter, HasItsOwnErrorOfPointingAndDrift) {
  const auto trend_of = [](int quarter, std::int64_t exposures) {
    Mission mission = mission_of(quarter);
    mission.simulation.exposures = exposures;
    mission.satellite.quarter_days = 1.0;
    mission.satellite.repointing.yaw = Arcseconds(3.0);
    mission.satellite.drift.pitch = Arcseconds(2.0);
    return Scene(mission, test::lab_catalogue({{60.0, 60.0, 1e4}})).attitude_trend();
  };
  // A run of two quarters, and the second alone: the same from its beginning on.
  const AttitudeTrend both = trend_of(0, 6000);
  const AttitudeTrend second = trend_of(1, 2000);
  for (const double t : {0.0, 1000.0, 40000.0}) {
    const double start = 86400.0 + t;
    EXPECT_NEAR(second.at(t, t).yaw, both.at(start, start).yaw, 1e-12);
    EXPECT_NEAR(second.at(t, t).pitch, both.at(start, start).pitch, 1e-12);
  }
  EXPECT_NE(second.at(0.0, 0.0).yaw, 0.0);
}

}  // namespace
}  // namespace astroid
