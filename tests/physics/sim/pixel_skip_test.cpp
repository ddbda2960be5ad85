// Effects on drawn charge that are left out are harmless: just below the threshold they move no flux by more than its
// tolerance, run anyway with the same draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 96;

std::vector<test::LabStar> field() {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < 9; ++i)
    stars.push_back(
        {16.0 + 32.0 * (i % 3) + 0.11 * i - 0.4, 16.0 + 32.0 * (i / 3) - 0.09 * i + 0.3, 3e3 * std::pow(2.0, i)});
  return stars;
}

struct Planned {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<Plan> plan;
};
Planned planned(const std::function<void(Mission&, double)>& set, double strength) {
  Mission mission = test::bare_mission(kSide, kSide);
  mission.ccd.readout_noise = Electrons(20.0);
  mission.simulation.exposures = 32;
  set(mission, strength);
  Planned p;
  p.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(field()));
  p.plan = std::make_shared<Plan>(make_plan(*p.scene));
  return p;
}

/// Drawn electrons in 6 x 6 px around each star, with the effect on or off.
std::vector<double> fluxes(const Planned& p, const std::string& effect, bool on, std::int64_t exposure) {
  auto plan = std::make_shared<Plan>(*p.plan);
  for (PlannedEffect& e : plan->effects)
    if (e.effect->spec().name == effect) e.need.needed = on;
  const Simulator simulator(p.scene, plan, 0);
  ExposureState state = simulator.make_state();
  std::vector<double> sums;
  simulator.simulate(exposure, state, [&](const EffectSpec& spec, const ExposureState& at) {
    if (spec.level != EffectLevel::kPixelSample) return;
    sums.clear();
    for (const SceneStar& star : p.scene->stars()) {
      const int x0 = static_cast<int>(std::floor(star.position.x)) - 2;
      const int y0 = static_cast<int>(std::floor(star.position.y)) - 2;
      double sum = 0.0;
      for (int y = y0; y < y0 + 6; ++y)
        for (int x = x0; x < x0 + 6; ++x) sum += at.sampled.whole().view(0).at(x, y);
      sums.push_back(sum);
    }
  });
  return sums;
}

struct SkipCase {
  const char* effect;
  std::function<void(Mission&, double)> set;
  double high;  ///< surely needed
};
void PrintTo(const SkipCase& c, std::ostream* out) {
  *out << c.effect;
}

class SkippedPixelEffect : public testing::TestWithParam<SkipCase> {};

TEST_P(SkippedPixelEffect, MovesNoFluxBeyondItsTolerance) {
  const SkipCase& c = GetParam();
  double low = 0.0;
  double high = c.high;
  ASSERT_TRUE(planned(c.set, high).plan->runs(c.effect));
  for (int i = 0; i < 60 && high - low > 0.01 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (planned(c.set, middle).plan->runs(c.effect) ? high : low) = middle;
  }
  ASSERT_GT(low, 0.0) << "the effect is never left out";
  const Planned p = planned(c.set, low);
  ASSERT_FALSE(p.plan->runs(c.effect));
  // The mean over many exposures: particles are rare, and what they do is a bias and a variance.
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
              low, worst_bias, worst_variance);
  EXPECT_LE(worst_bias, 1.0);
  EXPECT_LE(worst_variance, kVarianceTolerance);
  const bool rare = std::string(c.effect) == "cosmic-rays";
  EXPECT_TRUE(changed || rare) << "the effect did nothing: was it run?";
}

INSTANTIATE_TEST_SUITE_P(
    Effects, SkippedPixelEffect,
    testing::Values(
        SkipCase{"flat-field", [](Mission& m, double v) { m.ccd.flat_field.rms = v; }, 0.1},
        SkipCase{"charge-injection",
                 [](Mission& m, double v) {
                   m.ccd.charge_injection.every_rows = 4;
                   m.ccd.charge_injection.level = Electrons(v);
                 },
                 1e3},
        SkipCase{"cosmic-rays", [](Mission& m, double v) { m.ccd.cosmic_rays.rate = v; }, 100.0},
        SkipCase{"brighter-fatter",
                 [](Mission& m, double v) { m.ccd.brighter_fatter.serial = m.ccd.brighter_fatter.parallel = v; }, 1e-6},
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
      std::string name = parameter.param.effect;
      std::erase(name, '-');
      return name + std::to_string(parameter.index);
    });

}  // namespace
}  // namespace astroid
