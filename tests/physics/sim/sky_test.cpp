// The sky and stray light in the expected image.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 60;
constexpr int kRows = 40;

Simulator simulator_of(const Mission& mission) {
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{30.0, 20.0, 1e-6}}));
  return {scene, std::make_shared<const Plan>(make_plan(*scene)), 0};
}

TEST(StrayLight, HasItsLevelAtTheCentreAndItsGradients) {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.field.stray_light = {ElectronsPerSecond(10.0), 0.3, -0.2};
  const Simulator simulator = simulator_of(mission);
  ExposureState state = simulator.make_state();
  simulator.expect(0, state);
  const auto view = state.expected.whole().view(0);
  double mean = 0.0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) mean += view.at(x, y) / (kColumns * kRows);
  EXPECT_NEAR(mean, 210.0, 1e-9);
  // The centres of the corner pixels lie half a pixel inside.
  EXPECT_NEAR(view.at(0, 0), 210.0 * (1.0 - 0.3 * 59.0 / 60.0 + 0.2 * 39.0 / 40.0), 1e-9);
  EXPECT_NEAR(view.at(59, 39), 210.0 * (1.0 + 0.3 * 59.0 / 60.0 - 0.2 * 39.0 / 40.0), 1e-9);
}

TEST(ZodiacalSky, FollowsTheSeasonThroughTheResponseOfThePixels) {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.simulation.cycle = Seconds(10.0 * 86400.0);
  mission.simulation.exposures = 10;
  mission.field.sky = SkyModel::kZodiacal;
  mission.field.unresolved_stars = 20.0;
  mission.satellite.ra = Degrees(170.0);
  mission.satellite.dec = Degrees(10.0);
  mission.simulation.start_mjd = 61484.0;
  Mission patterned = mission;
  patterned.ccd.prnu = 0.02;
  const Simulator plain = simulator_of(mission);
  const Simulator response = simulator_of(patterned);
  ASSERT_TRUE(plain.plan().runs("zodiacal-sky"));
  ASSERT_FALSE(plain.plan().runs("sky"));
  ExposureState a = plain.make_state();
  ExposureState b = response.make_state();
  const ElectronsPerSecond unit = rate_of_one_s10(mission);
  double first = 0.0;
  double last = 0.0;
  std::vector<double> pattern;
  for (std::int64_t k = 0; k < 10; ++k) {
    plain.expect(k, a);
    response.expect(k, b);
    const auto pixels = a.expected.whole().pixels();
    double mean = 0.0;
    for (const double v : pixels) mean += v / (kColumns * kRows);
    const double expected =
        sky_rate(mission, unit, {170.0, 10.0}, Seconds(static_cast<double>(k) * 864000.0 + 10.5)).value() * 21.0;
    EXPECT_NEAR(mean / expected, 1.0, 2e-4) << k;  // of a detector of a quarter of a degree
    for (std::size_t i = 0; i < pixels.size(); i += 7) {
      const double ratio = b.expected.whole().pixels()[i] / pixels[i];
      if (k == 0) {
        pattern.push_back(ratio);
      } else {
        EXPECT_NEAR(ratio, pattern[i / 7], 1e-12);
      }
    }
    (k == 0 ? first : last) = mean;
  }
  std::printf("the sky changes from %.1f to %.1f e- in 90 days\n", first, last);
  EXPECT_GT(std::abs(last / first - 1.0), 0.05);
}

TEST(ZodiacalSky, RefusesARunThatLooksIntoTheSun) {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.simulation.cycle = Seconds(86400.0);
  mission.simulation.exposures = 300;
  mission.field.sky = SkyModel::kZodiacal;
  mission.satellite.ra = Degrees(180.0);
  mission.satellite.dec = Degrees(0.0);
  EXPECT_THROW(simulator_of(mission), InputError);  // the Sun is there in September
}

}  // namespace
}  // namespace astroid
