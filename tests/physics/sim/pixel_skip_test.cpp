// Effects on drawn charge that are left out are harmless: just below the threshold they move no flux by more than its
// tolerance, run anyway with the same draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "astroid/test/skip_threshold.hpp"

namespace astroid {
namespace {

using test::planned;
using test::Planned;
using test::SkipCase;

/// Drawn electrons in 6 x 6 px around each star, with the effect on or off.
std::vector<double> fluxes(const Planned& p, const std::string& effect, bool on, std::int64_t exposure) {
  const Simulator simulator(p.scene, test::with_effect(*p.plan, effect, on), 0);
  ExposureState state = simulator.make_state();
  std::vector<double> sums;
  simulator.simulate(exposure, state, [&](const EffectSpec& spec, const ExposureState& at) {
    if (spec.level == EffectLevel::kPixelSample) sums = test::star_sums(*p.scene, at.sampled.whole().view(0));
  });
  return sums;
}

class SkippedPixelEffect : public testing::TestWithParam<SkipCase> {};

TEST_P(SkippedPixelEffect, MovesNoFluxBeyondItsTolerance) {
  const SkipCase& c = GetParam();
  Mission mission = test::quiet_mission();
  c.set(mission, c.high);
  ASSERT_TRUE(planned(mission).plan->runs(c.effect));
  const double strength = test::skip_threshold(test::quiet_mission(), c);
  ASSERT_GT(strength, 0.0) << "the effect is never left out";
  mission = test::quiet_mission();
  c.set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs(c.effect));
  constexpr int kExposures = 32;
  std::vector<double> mean(p.scene->stars().size(), 0.0);
  std::vector<double> square(mean.size(), 0.0);
  bool changed = false;
  for (int exposure = 0; exposure < kExposures; ++exposure) {
    const std::vector<double> without = fluxes(p, c.effect, false, exposure);
    const std::vector<double> with = fluxes(p, c.effect, true, exposure);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double change = with[i] - without[i];
      changed = changed || change != 0.0;
      mean[i] += change / kExposures;
      square[i] += change * change / kExposures;
    }
  }
  double worst_bias = 0.0;
  double worst_variance = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double flux = p.scene->stars()[i].electrons;
    worst_bias = std::max(worst_bias, std::abs(mean[i]) / p.scene->summary().flux_tolerance(flux));
    worst_variance = std::max(worst_variance, square[i] / (flux + 36.0 * 400.0));
  }
  std::printf("%s at %.3g: moves a mean flux by at most %.2g of its tolerance, adds %.2g of its variance\n", c.effect,
              strength, worst_bias, worst_variance);
  EXPECT_LE(worst_bias, 1.0);
  EXPECT_LE(worst_variance, kVarianceTolerance);
  EXPECT_TRUE(changed) << "the effect did nothing: was it run?";
}

INSTANTIATE_TEST_SUITE_P(Effects, SkippedPixelEffect,
                         testing::Values(SkipCase{"flat-field", [](Mission& m, double v) { m.ccd.flat_field.rms = v; },
                                                  0.1},
                                         SkipCase{"charge-injection",
                                                  [](Mission& m, double v) {
                                                    m.ccd.charge_injection.every_rows = 4;
                                                    m.ccd.charge_injection.level = Electrons(v);
                                                  },
                                                  1e3},
                                         SkipCase{"brighter-fatter",
                                                  [](Mission& m, double v) {
                                                    m.ccd.brighter_fatter.serial = m.ccd.brighter_fatter.parallel = v;
                                                  },
                                                  1e-6},
                                         SkipCase{"cti",
                                                  [](Mission& m, double v) {
                                                    m.ccd.cti.model = CtiModel::kSimple;
                                                    m.ccd.cti.parallel = m.ccd.cti.serial = v;
                                                  },
                                                  1e-4},
                                         SkipCase{"cti",
                                                  [](Mission& m, double v) {
                                                    m.ccd.cti.model = CtiModel::kTraps;
                                                    m.ccd.cti.trap_density = {v};
                                                    m.ccd.cti.trap_cross_section = {1e-15};
                                                    m.ccd.cti.trap_release_time = {1.0};
                                                  },
                                                  1.0}),
                         [](const testing::TestParamInfo<SkipCase>& parameter) {
                           return test::test_name(parameter.param.effect) + std::to_string(parameter.index);
                         });

// Just below their threshold no particle comes in any number of exposures that a test can make. Both bounds are
// proportional to the rate, so they are judged where many come.
TEST(SkippedPixelEffect, ParticlesStayWithinTheBoundsOfTheirNeed) {
  Mission mission = test::quiet_mission();
  mission.ccd.cosmic_rays.rate = 300.0;
  const Planned p = planned(mission);
  const auto need = std::ranges::find_if(p.plan->effects,
                                         [](const PlannedEffect& e) { return e.effect->spec().name == "cosmic-rays"; });
  ASSERT_TRUE(need->need.needed);
  constexpr int kExposures = 32;
  double mean = 0.0;
  double square = 0.0;
  for (int exposure = 0; exposure < kExposures; ++exposure) {
    const std::vector<double> without = fluxes(p, "cosmic-rays", false, exposure);
    const std::vector<double> with = fluxes(p, "cosmic-rays", true, exposure);
    for (std::size_t i = 0; i < with.size(); ++i) {
      const double change = with[i] - without[i];
      mean += change / (kExposures * static_cast<double>(with.size()));
      square += change * change / (kExposures * static_cast<double>(with.size()));
    }
  }
  const SceneSummary& s = p.scene->summary();
  const double variance = square - mean * mean;
  const double bound =
      need->need.variance_bound * (s.faintest_target_electrons + s.pixel_noise_variance - s.background);
  std::printf("particles: %.4g e- of at most %.4g; variance %.3g of at most %.3g e-2\n", mean, need->need.bias_bound,
              variance, bound);
  EXPECT_GT(mean, 0.0);
  EXPECT_LE(mean, need->need.bias_bound);
  EXPECT_LE(variance, bound);
}

}  // namespace
}  // namespace astroid
