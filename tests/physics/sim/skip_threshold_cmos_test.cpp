// CMOS effects just below their thresholds, run anyway: no star's flux moves by more than its tolerance, no variance
// grows by more than what is allowed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "astroid/core/detector_noise.hpp"
#include "astroid/test/skip_threshold.hpp"

namespace astroid {
namespace {

using test::planned;
using test::Planned;
using test::SkipCase;
using test::with_effect;

Mission quiet_mission() {
  Mission mission = test::bare_mission(test::kSkipSide, test::kSkipSide);
  mission.simulation.type = DetectorType::kCmos;
  mission.ccd.gain = Gain(0.05);
  mission.ccd.bias = Adu(2000.0);
  return mission;
}

double threshold(const char* effect, const test::SetStrength& set, double high) {
  return test::skip_threshold(quiet_mission(), {effect, set, high});
}

/// Electrons before they are digitised in 6 x 6 px around each star: rounding would hide what is looked for.
std::vector<double> fluxes(const Planned& p, const std::shared_ptr<const Plan>& plan, std::int64_t exposure) {
  const Simulator simulator(p.scene, plan, 0);
  ExposureState state = simulator.make_state();
  const CcdSettings& ccd = p.scene->mission().ccd;
  constexpr double kPixels = 36.0;
  std::vector<double> sums;
  simulator.simulate(exposure, state, [&](const EffectSpec& spec, const ExposureState& seen) {
    if (spec.name != "adc") return;
    sums = test::star_sums(*p.scene, seen.analog.whole().view(0));
    for (double& sum : sums) sum = (sum - kPixels * ccd.bias.value()) * ccd.gain.value();
  });
  return sums;
}

class CmosSkippedBelowThreshold : public testing::TestWithParam<SkipCase> {};

TEST_P(CmosSkippedBelowThreshold, IsHarmless) {
  const SkipCase& c = GetParam();
  const double strength = threshold(c.effect, c.set, c.high);
  ASSERT_GT(strength, 0.0) << "the effect is never left out";
  Mission mission = quiet_mission();
  c.set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs(c.effect));
  const std::shared_ptr<const Plan> without = with_effect(*p.plan, "photon-noise", false);
  const std::shared_ptr<const Plan> with = with_effect(*without, c.effect);
  double worst = 0.0;
  for (const std::int64_t exposure : {0, 1, 2, 3}) {
    worst = std::max(worst, test::worst_change(*p.scene, fluxes(p, without, exposure), fluxes(p, with, exposure)));
  }
  std::printf("%s at %.3g: moves a flux by at most %.2f of its tolerance\n", c.effect, strength, worst);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 0.0) << "the effect did nothing: was it run?";
}

INSTANTIATE_TEST_SUITE_P(
    Effects, CmosSkippedBelowThreshold,
    testing::Values(SkipCase{"inter-pixel-capacitance", [](Mission& m, double v) { m.cmos.coupling = v; }, 0.1},
                    SkipCase{"persistence",
                             [](Mission& m, double v) { m.cmos.persistence = {.fraction = {v}, .time = {100.0}}; },
                             0.1},
                    SkipCase{"pixel-gain", [](Mission& m, double v) { m.cmos.gain_rms = v; }, 0.1},
                    SkipCase{"pixel-offset", [](Mission& m, double v) { m.cmos.offset_rms = Adu(v); }, 1000.0},
                    SkipCase{"telegraph-pixels",
                             [](Mission& m, double v) {
                               m.cmos.telegraph_fraction = 0.02;
                               m.cmos.telegraph_current = ElectronsPerSecond(v);
                               m.cmos.telegraph_low = m.cmos.telegraph_high = Seconds(50.0);
                             },
                             10.0}),
    [](const testing::TestParamInfo<SkipCase>& parameter) { return test::test_name(parameter.param.effect); });

TEST(CmosSkippedBelowThreshold, NoiseIsHarmless) {
  // Variance that 36 pixels would add, against the photon noise of the faintest star.
  const double faintest = 3e3;
  const double reset = threshold(
      "reset-noise", [](Mission& m, double v) { m.cmos.reset_noise = Electrons(v); }, 100.0);
  ASSERT_GT(reset, 0.0);
  EXPECT_LE(36.0 * reset * reset, 1.01 * kVarianceTolerance * faintest);
  const double column = threshold(
      "column-noise", [](Mission& m, double v) { m.cmos.column_noise = Electrons(v); }, 100.0);
  ASSERT_GT(column, 0.0);
  EXPECT_LE(6.0 * 36.0 * column * column, 1.01 * kVarianceTolerance * faintest);
  const double readout = threshold(
      "readout-noise",
      [](Mission& m, double v) {
        m.cmos.reads = 8;
        m.ccd.readout_noise = Electrons(v);
      },
      100.0);
  ASSERT_GT(readout, 0.0);
  Mission mission = quiet_mission();
  mission.cmos.reads = 8;
  mission.ccd.readout_noise = Electrons(readout);
  const double fitted = readout * fitted_readout_factor(mission);
  EXPECT_LE(36.0 * fitted * fitted, 1.01 * kVarianceTolerance * faintest);
}

TEST(CmosSkippedBelowThreshold, SaturationIsNeverReached) {
  const double inverse = threshold(
      "pixel-saturation", [](Mission& m, double v) { m.ccd.full_well = Electrons(1.0 / v); }, 1e-3);
  ASSERT_GT(inverse, 0.0);
  Mission mission = quiet_mission();
  mission.ccd.full_well = Electrons(1.0 / inverse);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs("pixel-saturation"));
  const std::shared_ptr<const Plan> with = with_effect(*p.plan, "pixel-saturation");
  for (const std::int64_t exposure : {0, 1, 2, 3, 4, 5, 6, 7})
    EXPECT_EQ(fluxes(p, p.plan, exposure), fluxes(p, with, exposure));
}

}  // namespace
}  // namespace astroid
