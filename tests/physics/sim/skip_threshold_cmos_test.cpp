// CMOS effects just below their thresholds, run anyway: no star's flux moves by more than its tolerance, no variance
// grows by more than what is allowed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "astroid/core/detector_noise.hpp"
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

Mission quiet_mission() {
  Mission mission = test::bare_mission(kSide, kSide);
  mission.simulation.type = DetectorType::kCmos;
  mission.ccd.gain = Gain(0.05);
  mission.ccd.bias = Adu(2000.0);
  return mission;
}

struct Planned {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<Plan> plan;
};
Planned planned(const Mission& mission) {
  Planned p;
  p.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(field()));
  p.plan = std::make_shared<Plan>(make_plan(*p.scene));
  return p;
}

using Setter = std::function<void(Mission&, double)>;

/// The largest strength (to 1 %) at which the plan leaves the effect out.
double threshold(const std::string& effect, const Setter& set, double high) {
  double low = 0.0;
  for (int i = 0; i < 60 && high - low > 0.01 * low; ++i) {
    const double middle = 0.5 * (low + high);
    Mission mission = quiet_mission();
    set(mission, middle);
    (planned(mission).plan->runs(effect) ? high : low) = middle;
  }
  return low;
}

void force(Plan& plan, const std::string& effect, bool runs) {
  for (PlannedEffect& e : plan.effects)
    if (e.effect->spec().name == effect) e.need.needed = runs;
}

/// Electrons before they are digitised in 6 x 6 px around each star: rounding would hide what is looked for.
std::vector<double> fluxes(const Planned& p, const Plan& plan, std::int64_t exposure) {
  const Simulator simulator(p.scene, std::make_shared<const Plan>(plan), 0);
  ExposureState state = simulator.make_state();
  const CcdSettings& ccd = p.scene->mission().ccd;
  std::vector<double> sums;
  simulator.simulate(exposure, state, [&](const EffectSpec& spec, const ExposureState& seen) {
    if (spec.name != "adc") return;
    const auto analog = seen.analog.whole().view(0);
    for (const SceneStar& star : p.scene->stars()) {
      double sum = 0.0;
      const int x0 = static_cast<int>(std::floor(star.position.x)) - 2;
      const int y0 = static_cast<int>(std::floor(star.position.y)) - 2;
      for (int y = y0; y < y0 + 6; ++y)
        for (int x = x0; x < x0 + 6; ++x) sum += (analog.at(x, y) - ccd.bias.value()) * ccd.gain.value();
      sums.push_back(sum);
    }
  });
  return sums;
}

struct SkipCase {
  const char* effect;
  Setter set;
  double high;  ///< surely needed
};

class CmosSkippedBelowThreshold : public testing::TestWithParam<SkipCase> {};

TEST_P(CmosSkippedBelowThreshold, IsHarmless) {
  const SkipCase& c = GetParam();
  const double strength = threshold(c.effect, c.set, c.high);
  ASSERT_GT(strength, 0.0) << "the effect is never left out";
  Mission mission = quiet_mission();
  c.set(mission, strength);
  const Planned p = planned(mission);
  ASSERT_FALSE(p.plan->runs(c.effect));
  Plan without = *p.plan;
  force(without, "photon-noise", false);
  Plan with = without;
  force(with, c.effect, true);
  double worst = 0.0;
  for (const std::int64_t exposure : {0, 1, 2, 3}) {
    const std::vector<double> a = fluxes(p, without, exposure);
    const std::vector<double> b = fluxes(p, with, exposure);
    for (std::size_t i = 0; i < a.size(); ++i)
      worst = std::max(worst, std::abs(b[i] - a[i]) / p.scene->summary().flux_tolerance(p.scene->stars()[i].electrons));
  }
  std::printf("%s at %.3g: moves a flux by at most %.2f of its tolerance\n", c.effect, strength, worst);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 0.0) << "the effect did nothing: was it run?";
}

INSTANTIATE_TEST_SUITE_P(
    Effects, CmosSkippedBelowThreshold,
    testing::Values(SkipCase{"inter-pixel-capacitance", [](Mission& m, double v) { m.cmos.coupling = v; }, 0.1},
                    SkipCase{"pixel-gain", [](Mission& m, double v) { m.cmos.gain_rms = v; }, 0.1},
                    SkipCase{"pixel-offset", [](Mission& m, double v) { m.cmos.offset_rms = Adu(v); }, 1000.0},
                    SkipCase{"telegraph-pixels",
                             [](Mission& m, double v) {
                               m.cmos.telegraph_fraction = 0.02;
                               m.cmos.telegraph_current = ElectronsPerSecond(v);
                               m.cmos.telegraph_low = m.cmos.telegraph_high = Seconds(50.0);
                             },
                             10.0}),
    [](const testing::TestParamInfo<SkipCase>& parameter) {
      std::string name = parameter.param.effect;
      std::erase(name, '-');
      return name;
    });

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
  Plan with = *p.plan;
  force(with, "pixel-saturation", true);
  for (const std::int64_t exposure : {0, 1, 2, 3, 4, 5, 6, 7})
    EXPECT_EQ(fluxes(p, *p.plan, exposure), fluxes(p, with, exposure));
}

}  // namespace
}  // namespace astroid
