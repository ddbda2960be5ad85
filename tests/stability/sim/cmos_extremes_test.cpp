// CMOS at its extremes: as many reads as there may be, no noise at all, pixels that fill at once or hold nothing,
// detectors of one pixel or one row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

Mission cmos_mission(int columns, int rows, int reads) {
  Mission mission = test::bare_mission(columns, rows);
  mission.simulation.type = DetectorType::kCmos;
  mission.ccd.bias = Adu(1000.0);
  mission.ccd.adc_bits = 16;
  mission.ccd.full_well = Electrons(50000.0);
  mission.cmos.reads = reads;
  mission.cmos.coupling = 0.01;
  mission.cmos.corner_coupling = 0.002;
  return mission;
}

std::vector<double> electrons(const Mission& mission, const std::vector<test::LabStar>& stars) {
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(0, state);
  std::vector<double> values;
  for (const float count : state.frame.pixels.pixels())
    values.push_back((static_cast<double>(count) - mission.ccd.bias.value()) * mission.ccd.gain.value());
  return values;
}

TEST(CmosExtremes, DetectorsOfOnePixelOrOneRowWork) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, std::pair{1, 17}, std::pair{23, 1}, std::pair{2, 2}})
    for (const int reads : {1, 2, 7})
      for (const double value : electrons(cmos_mission(columns, rows, reads), {{0.0, 0.0, 3e4}}))
        EXPECT_TRUE(std::isfinite(value)) << columns << " x " << rows << ", " << reads << " reads";
}

TEST(CmosExtremes, AsManyReadsAsMayBe) {
  Mission mission = cmos_mission(40, 40, 254);
  mission.field.sky_background = ElectronsPerSecond(100.0);
  mission.ccd.readout_noise = Electrons(20.0);
  mission.cmos.coupling = mission.cmos.corner_coupling = 0.0;
  const std::vector<double> values = electrons(mission, {{20.0, 20.0, 1e-9}});
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  EXPECT_NEAR(mean, 2100.0, 4.0 * std::sqrt(expected_pixel_noise(mission).variance() / 1600.0));
}

TEST(CmosExtremes, WithoutAnyNoiseTheRampIsExact) {
  Mission mission = cmos_mission(32, 32, 5);
  mission.cmos.coupling = mission.cmos.corner_coupling = 0.0;
  mission.ccd.adc_bits = 24;
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{16.2, 15.7, 4e4}}));
  auto plan = std::make_shared<Plan>(make_plan(*scene));
  for (PlannedEffect& e : plan->effects)
    if (e.effect->spec().name == "photon-noise") e.need.needed = false;
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(0, state);
  ExposureState expected = simulator.make_state();
  simulator.expect(0, expected);
  for (std::size_t i = 0; i < state.frame.pixels.size(); ++i)
    EXPECT_NEAR(static_cast<double>(state.frame.pixels.pixels()[i]) - 1000.0, expected.expected.whole().pixels()[i],
                1.5);  // two roundings
}

TEST(CmosExtremes, StarsOfAnyBrightnessAreFiniteAndFlagged) {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < 8; ++i) stars.push_back({12.0 + 24.0 * i, 12.3, std::pow(10.0, 2 * i)});
  for (const int reads : {1, 2, 16}) {
    const Mission mission = cmos_mission(200, 24, reads);
    const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
    const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
    ExposureState state = simulator.make_state();
    simulator.simulate(0, state);
    const double top = std::ldexp(1.0, delivered_bits(mission)) - 1.0;
    for (const float count : state.frame.pixels.pixels())
      ASSERT_TRUE(count >= 0.0F && static_cast<double>(count) <= top) << count;
    // The brightest is full at once.
    EXPECT_NE(state.frame.flags.view(0).at(180, 12) & (pixel_flag::kFullWell | pixel_flag::kAdcSaturated), 0);
    EXPECT_EQ(state.frame.flags.view(0).at(12, 12), 0);
  }
}

}  // namespace
}  // namespace astroid
