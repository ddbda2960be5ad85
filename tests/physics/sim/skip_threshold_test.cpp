// Skipping is a claim about accuracy: an effect just below its threshold, run anyway, moves no star's flux by more than
// the tolerance, and adds no more than the allowed variance.
#include "astroid/test/skip_threshold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>

namespace astroid {
namespace {

using test::planned;
using test::Planned;
using test::quiet_mission;
using test::SkipCase;
using test::with_effect;

double threshold(const char* effect, const test::SetStrength& set, double high) {
  return test::skip_threshold(quiet_mission(), {effect, set, high});
}

/// Expected electrons in 6 x 6 px around each star.
std::vector<double> fluxes(const Planned& p, const std::shared_ptr<const Plan>& plan, std::int64_t exposure) {
  const Simulator simulator(p.scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.expect(exposure, state);
  return test::star_sums(*p.scene, state.expected.whole().view(0));
}

class SkippedBelowThreshold : public testing::TestWithParam<SkipCase> {};

TEST_P(SkippedBelowThreshold, IsHarmless) {
  const SkipCase& c = GetParam();
  const double strength = threshold(c.effect, c.set, c.high);
  ASSERT_GT(strength, 0.0) << "the effect is never left out";
  Mission mission = quiet_mission();
  c.set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs(c.effect));
  const std::vector<double> without = fluxes(p, p.plan, 0);
  const std::vector<double> with = fluxes(p, with_effect(*p.plan, c.effect), 0);
  const double worst = test::worst_change(*p.scene, without, with);
  std::printf("%s at %.3g: moves a flux by at most %.2f of its tolerance\n", c.effect, strength, worst);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 0.0) << "the effect did nothing: was it run?";
}

INSTANTIATE_TEST_SUITE_P(
    Effects, SkippedBelowThreshold,
    testing::Values(
        SkipCase{"sky", [](Mission& m, double v) { m.field.sky_background = ElectronsPerSecond(v); }, 10.0},
        SkipCase{"stray-light",
                 [](Mission& m, double v) {
                   m.field.stray_light = {ElectronsPerSecond(v), 0.5, -0.5};
                 },
                 10.0},
        SkipCase{"zodiacal-sky",
                 [](Mission& m, double v) {
                   // The pixel makes the sky faint: its scale, not the stars of the laboratory, is the
                   // strength.
                   m.field.sky = SkyModel::kZodiacal;
                   m.ccd.pixel_scale = PixelScale(v);
                 },
                 15.0},
        SkipCase{"dark-current", [](Mission& m, double v) { m.ccd.dark_current = ElectronsPerSecond(v); }, 10.0},
        SkipCase{
            "open-shutter-smearing",
            [](Mission& m, double v) { m.ccd.smearing = {.model = SmearingModel::kOpenShutter, .time = Seconds(v)}; },
            10.0},
        SkipCase{"frame-transfer-smearing",
                 [](Mission& m, double v) {
                   m.ccd.smearing = {.model = SmearingModel::kFrameTransfer, .time = Seconds(v)};
                   m.ccd.smearing.clear_time = Seconds(0.0);
                 },
                 10.0},
        SkipCase{"throughput", [](Mission& m, double v) { m.telescope.throughput.beginning_of_life = 1.0 - v; }, 0.1},
        SkipCase{"breathing",
                 [](Mission& m, double v) { m.psf.breathing = {.amplitude = Pixels(v), .period = Seconds(42.0)}; },
                 0.3},
        SkipCase{"ghosts",
                 [](Mission& m, double v) {
                   m.telescope.ghosts = {.fraction = v, .radius = Pixels(20.0), .brighter_than = Magnitude(30.0)};
                 },
                 0.1},
        SkipCase{"vignetting",
                 [](Mission& m, double v) {
                   m.ccd.pixel_scale = PixelScale(200.0);
                   m.telescope.vignetting.model = VignettingModel::kPolynomial;
                   m.telescope.vignetting.polynomial = {v};
                 },
                 1.0},
        SkipCase{"prnu", [](Mission& m, double v) { m.ccd.prnu = v; }, 0.1}),
    [](const testing::TestParamInfo<SkipCase>& parameter) { return test::test_name(parameter.param.effect); });

TEST(SkippedBelowThreshold, JitterIsHarmless) {
  const auto set = [](Mission& m, double arcsec) {
    m.satellite.jitter.model = JitterModel::kRedNoise;
    m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(arcsec);
  };
  const double strength = threshold("jitter-model", set, 1.0);
  ASSERT_GT(strength, 0.0);
  Mission mission = quiet_mission();
  set(mission, strength);
  const Planned off = planned(mission);
  ASSERT_FALSE(off.plan->runs("jitter-model"));
  // Just above, the plan knows how to move the stars: take that plan with the motion of just below.
  Mission above = quiet_mission();
  set(above, 1.05 * strength);
  const Planned on = planned(above);
  ASSERT_TRUE(on.plan->runs("jitter-model"));
  const std::vector<double> still = fluxes(off, off.plan, 0);
  std::vector<double> squares(still.size(), 0.0);
  std::vector<double> means(still.size(), 0.0);
  const auto exposures = static_cast<double>(mission.simulation.exposures);
  for (std::int64_t k = 0; k < mission.simulation.exposures; ++k) {
    const std::vector<double> moved = fluxes(on, on.plan, k);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const double d = moved[i] / still[i] - 1.0;
      squares[i] += d * d / exposures;
      means[i] += d / exposures;
    }
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double flux = off.scene->stars()[i].electrons;
    // 5 % more motion than the threshold: 1.05² in variance.
    EXPECT_LE(squares[i], 1.11 * kVarianceTolerance * off.scene->summary().relative_variance_in_bin(flux)) << i;
    EXPECT_GT(squares[i], 0.0);
  }
}

TEST(SkippedBelowThreshold, ReadoutNoiseIsHarmless) {
  const auto set = [](Mission& m, double electrons) { m.ccd.readout_noise = Electrons(electrons); };
  const double strength = threshold("readout-noise", set, 100.0);
  ASSERT_GT(strength, 0.0);
  Mission mission = quiet_mission();
  set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs("readout-noise"));
  // Variance that 36 pixels would add, against the photon noise of the faintest star.
  EXPECT_LE(36.0 * strength * strength,
            1.01 * kVarianceTolerance * p.scene->summary().faintest_target_electrons + 1e-3);
}

TEST(SkippedBelowThreshold, IntraPixelResponseIsHarmless) {
  const auto set = [](Mission& m, double depth) { m.psf.intra_pixel.depth = depth; };
  const double strength = threshold("intra-pixel-response", set, 1e-3);
  ASSERT_GT(strength, 0.0);
  Mission mission = quiet_mission();
  set(mission, strength);
  const Planned off = planned(mission);
  ASSERT_FALSE(off.plan->runs("intra-pixel-response"));
  // It is a part of the PSF, so it runs where the accuracy asked for is better.
  mission.simulation.accuracy = Ppm(0.01);
  const Planned on = planned(mission);
  ASSERT_TRUE(on.plan->runs("intra-pixel-response"));
  const std::vector<double> without = fluxes(off, off.plan, 0);
  const std::vector<double> with = fluxes(on, on.plan, 0);
  const double worst = test::worst_change(*off.scene, without, with);
  std::printf("intra-pixel-response at %.3g: moves a flux by at most %.2f of its tolerance\n", strength, worst);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 0.0);
}

TEST(SkippedBelowThreshold, FullWellIsNeverReached) {
  const auto set = [](Mission& m, double inverse) { m.ccd.full_well = Electrons(1.0 / inverse); };
  const double strength = threshold("full-well", set, 1e-3);
  ASSERT_GT(strength, 0.0);
  Mission mission = quiet_mission();
  set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs("full-well"));
  const Simulator without(p.scene, p.plan, 0);
  const Simulator with(p.scene, with_effect(*p.plan, "full-well"), 0);
  ExposureState a = without.make_state();
  ExposureState b = with.make_state();
  for (int exposure = 0; exposure < 20; ++exposure) {
    without.simulate(exposure, a);
    with.simulate(exposure, b);
    EXPECT_TRUE(std::ranges::equal(a.frame.pixels.pixels(), b.frame.pixels.pixels()));
    EXPECT_EQ(b.lost_electrons, 0.0);
  }
}

/// Analogue signal in 6 x 6 px around each star, in electrons.
std::vector<double> read_fluxes(const Planned& p, const std::shared_ptr<const Plan>& plan, std::int64_t exposure) {
  const Simulator simulator(p.scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(exposure, state, [](const EffectSpec&, const ExposureState&) {});  // so that planes are whole
  std::vector<double> sums = test::star_sums(*p.scene, state.analog.whole().view(0));
  for (double& sum : sums) sum *= p.scene->mission().ccd.gain.value();
  return sums;
}

class ReadoutSkippedBelowThreshold : public testing::TestWithParam<SkipCase> {};

TEST_P(ReadoutSkippedBelowThreshold, IsHarmless) {
  const SkipCase& c = GetParam();
  const double strength = threshold(c.effect, c.set, c.high);
  ASSERT_GT(strength, 0.0) << "the effect is never left out";
  Mission mission = quiet_mission();
  c.set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs(c.effect));
  double worst = 0.0;
  for (const std::int64_t exposure : {3, 11}) {  // the draws of both are the same
    worst = std::max(worst, test::worst_change(*p.scene, read_fluxes(p, p.plan, exposure),
                                               read_fluxes(p, with_effect(*p.plan, c.effect), exposure)));
  }
  std::printf("%s at %.3g: moves a flux by at most %.2f of its tolerance\n", c.effect, strength, worst);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 0.0) << "the effect did nothing: was it run?";
}

INSTANTIATE_TEST_SUITE_P(
    Effects, ReadoutSkippedBelowThreshold,
    testing::Values(SkipCase{"non-linearity",
                             [](Mission& m, double v) {
                               m.ccd.electronics.nonlinearity = {0.0, v, 0.0};
                             },
                             1.0},
                    SkipCase{"bias-drift", [](Mission& m, double v) { m.ccd.electronics.bias_drift = v; }, 10.0},
                    SkipCase{"cross-talk",
                             [](Mission& m, double v) {
                               m.ccd.nodes.count = 4;
                               m.ccd.nodes.cross_talk = v;
                             },
                             0.1}),
    [](const testing::TestParamInfo<SkipCase>& parameter) { return test::test_name(parameter.param.effect); });

/// Mean square of what an effect adds to the flux of the faintest star, e-², over the exposures of the run.
double added_to_the_faintest(const Planned& p, const char* effect) {
  const std::int64_t exposures = p.scene->mission().simulation.exposures;
  double square = 0.0;
  for (std::int64_t exposure = 0; exposure < exposures; ++exposure) {
    const double without = read_fluxes(p, p.plan, exposure).front();
    const double with = read_fluxes(p, with_effect(*p.plan, effect), exposure).front();
    square += (with - without) * (with - without) / static_cast<double>(exposures);
  }
  return square;
}

TEST(SkippedBelowThreshold, PickUpNoiseIsHarmless) {
  const auto set = [](Mission& m, double adu) {
    m.ccd.electronics.pick_up = {.amplitude = adu, .column_frequency = 0.01, .row_frequency = -0.007};
  };
  const double strength = threshold("pick-up-noise", set, 100.0);
  ASSERT_GT(strength, 0.0);
  Mission mission = quiet_mission();
  set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs("pick-up-noise"));
  const double square = added_to_the_faintest(p, "pick-up-noise");
  const double variance = p.scene->summary().faintest_target_electrons + p.scene->summary().pixel_noise_variance * 36.0;
  std::printf("pick-up-noise at %.3g ADU: %.2g of the variance of the faintest star\n", strength, square / variance);
  // The mean square of 32 random phases scatters by 12 %.
  EXPECT_LE(square, 1.5 * kVarianceTolerance * variance);
  EXPECT_GT(square, 0.0);
}

TEST(SkippedBelowThreshold, RowOffsetIsHarmless) {
  const auto set = [](Mission& m, double adu) { m.ccd.electronics.row_offset = adu; };
  const double strength = threshold("row-offset", set, 100.0);
  ASSERT_GT(strength, 0.0);
  Mission mission = quiet_mission();
  set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs("row-offset"));
  const double square = added_to_the_faintest(p, "row-offset");
  // The variance that 32 exposures show scatters by 25 %.
  EXPECT_LE(square, 2.0 * kVarianceTolerance * p.scene->summary().faintest_target_electrons);
  EXPECT_GT(square, 0.0);
}

}  // namespace
}  // namespace astroid
