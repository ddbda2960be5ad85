// What the effects between pixels do in the chain: where they come, and the laws that a frame shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/statistics/sums.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

struct ChainRun {
  explicit ChainRun(const Mission& mission, const std::vector<test::LabStar>& stars = {{10.0, 10.0, 1e-6}})
      : scene(std::make_shared<const Scene>(mission, test::lab_catalogue(stars))),
        plan(std::make_shared<const Plan>(make_plan(*scene))),
        simulator(scene, plan, 0),
        state(simulator.make_state()) {}
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  Simulator simulator;
  ExposureState state;
};

Mission flat(int side, double level) {
  Mission mission = test::bare_mission(side, side);
  mission.field.sky_background = ElectronsPerSecond(level / mission.simulation.exposure_time.value());
  return mission;
}

TEST(PixelEffects, AreInTheOrderOfTheCharge) {
  const ChainRun run(flat(20, 100.0));
  const auto place = [&](std::string_view name) {
    return std::ranges::find_if(run.plan->effects,
                                [&](const PlannedEffect& e) { return e.effect->spec().name == name; }) -
           run.plan->effects.begin();
  };
  EXPECT_LT(place("flat-field"), place("dark-current"));
  EXPECT_LT(place("charge-injection"), place("photon-noise"));
  EXPECT_LT(place("photon-noise"), place("cosmic-rays"));
  EXPECT_LT(place("photon-noise"), place("brighter-fatter"));
  EXPECT_LT(place("brighter-fatter"), place("full-well"));
  EXPECT_LT(place("full-well"), place("cti"));
  EXPECT_LT(place("cti"), place("readout-noise"));
}

// A pattern that were drawn anew in each exposure would average out over a series as noise does.
TEST(DarkCurrent, HasThePatternOfItsPixelsInEveryExposure) {
  constexpr int kSide = 200;
  constexpr double kRate = 1.2;
  constexpr double kDsnu = 0.15;
  Mission mission = test::bare_mission(kSide, kSide);
  mission.telescope.cameras = 2;
  mission.ccd.dark_current = ElectronsPerSecond(kRate);
  mission.ccd.dsnu = kDsnu;
  ChainRun run(mission);
  const auto expected = [](const Simulator& simulator, std::int64_t exposure) {
    ExposureState state = simulator.make_state();
    simulator.expect(exposure, state);
    const auto pixels = std::as_const(state.expected).whole().pixels();
    return std::vector<double>(pixels.begin(), pixels.end());
  };
  const std::vector<double> first = expected(run.simulator, 0);
  EXPECT_EQ(first, expected(run.simulator, 1));
  EXPECT_EQ(first, expected(run.simulator, mission.simulation.exposures - 1));
  EXPECT_NE(first, expected(Simulator(run.scene, run.plan, 1), 0)) << "another camera has another detector";
  const double level = kRate * mission.simulation.exposure_time.value();
  RunningMoments moments;
  for (const double value : first) moments.add(value / level - 1.0);
  const double n = kSide * kSide;
  EXPECT_NEAR(moments.mean(), 0.0, 4.0 * kDsnu / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(moments.variance()) / kDsnu, 1.0, 4.0 / std::sqrt(2.0 * n));
}

TEST(FlatField, MultipliesByItsPatternBesideThatOfThePixels) {
  Mission mission = flat(100, 1e4);
  mission.ccd.flat_field = {.rms = 0.02, .exponent = 1.0};
  ChainRun run(mission);
  run.simulator.expect(0, run.state);
  double mean = 0.0;
  double squares = 0.0;
  for (const double value : run.state.expected.whole().pixels()) {
    mean += value / 1e4 / 1e4;
    squares += (value / 1e4 - 1.0) * (value / 1e4 - 1.0) / 1e4;
  }
  EXPECT_NEAR(mean, 1.0, 1e-6);
  EXPECT_NEAR(std::sqrt(squares) / 0.02, 1.0, 1e-4);
}

TEST(ChargeInjection, FillsEveryNthRowWithPoissonNoise) {
  Mission mission = test::bare_mission(200, 100);
  mission.ccd.charge_injection = {.every_rows = 10, .first_row = 3, .level = Electrons(2000.0)};
  ChainRun run(mission);
  run.simulator.simulate(0, run.state);
  double mean = 0.0;
  double variance = 0.0;
  int pixels = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 20; x < 200; ++x) {
      const double value = static_cast<double>(run.state.frame.pixels.view(0).at(x, y));
      if (y % 10 != 3) {
        EXPECT_EQ(value, 0.0);
        continue;
      }
      mean += value;
      variance += (value - 2000.0) * (value - 2000.0);
      ++pixels;
    }
  EXPECT_NEAR(mean / pixels, 2000.0, 5.0 * std::sqrt(2000.0 / pixels));
  EXPECT_NEAR(variance / pixels / 2000.0, 1.0, 5.0 * std::sqrt(2.0 / pixels));
}

TEST(CosmicRays, AddWhatTheConfigurationSaysAndAreFlagged) {
  Mission mission = test::bare_mission(400, 400);
  mission.ccd.cosmic_rays.rate = 100.0;
  ChainRun run(mission);
  const double hits = 100.0 * 18e-4 * 18e-4 * mission.simulation.cycle.value() * 400.0 * 400.0;
  double sum = 0.0;
  for (int exposure = 0; exposure < 10; ++exposure) {
    run.simulator.simulate(exposure, run.state);
    const auto pixels = run.state.frame.pixels.pixels();
    const auto flags = run.state.frame.flags.pixels();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      sum += static_cast<double>(pixels[i]);
      EXPECT_TRUE(pixels[i] == 0.0F || (flags[i] & pixel_flag::kCosmicRay) != 0);
    }
  }
  // Rounding to whole ADU of the many pixels with parts of a track averages out.
  const double expected = 10.0 * hits * 4094.88;
  const double deviation = std::sqrt(10.0 * hits * (4094.88 * 4094.88 + 1206.8 * 1206.8));
  std::printf("%.0f hits expected: z of the charge %.2f\n", 10.0 * hits, (sum - expected) / deviation);
  EXPECT_LT(std::abs(sum - expected), 4.0 * deviation);
}

TEST(BrighterFatter, ComesAfterPhotonNoiseAndBendsThePhotonTransferCurve) {
  Mission mission = flat(400, 1e5);
  mission.ccd.brighter_fatter = {.serial = 5e-7, .parallel = 5e-7, .decay = 0.5, .range = 2};
  ChainRun run(mission);
  run.simulator.simulate(0, run.state);
  double variance = 0.0;
  int pixels = 0;
  for (int y = 20; y < 390; ++y)
    for (int x = 20; x < 390; ++x) {
      const double d = static_cast<double>(run.state.frame.pixels.view(0).at(x, y)) - 1e5;
      variance += d * d;
      ++pixels;
    }
  // 1 - 2 (5e-7 + 5e-7) 1e5 to first order, 0.8; the squares of what comes from neighbours give a little back.
  std::printf("variance / mean of a flat field of 1e5 e-: %.4f\n", variance / pixels / 1e5);
  EXPECT_NEAR(variance / pixels / 1e5, 0.812, 5.0 * std::sqrt(2.0 / pixels) + 0.004);
}

TEST(Cti, ShowsInTheOverscanOfAFlatField) {
  Mission mission = flat(300, 2e4);
  mission.ccd.reference = {.prescan = 3, .serial_overscan = 5, .parallel_overscan = 5};
  mission.ccd.cti.model = CtiModel::kSimple;
  mission.ccd.cti.parallel = 2e-5;
  mission.ccd.cti.serial = 1e-5;
  ChainRun run(mission);
  double first_row = 0.0;
  double first_column = 0.0;
  constexpr int kExposures = 8;
  for (int exposure = 0; exposure < kExposures; ++exposure) {
    run.simulator.simulate(exposure, run.state);
    for (int i = 0; i < 300; ++i) {
      for (std::size_t r = 0; r < run.scene->layout()->regions().size(); ++r) {
        const auto view = run.state.frame.pixels.view(r);
        if (view.area().contains(i, 300)) first_row += static_cast<double>(view.at(i, 300)) / 300.0 / kExposures;
        if (view.area().contains(300, i)) first_column += static_cast<double>(view.at(300, i)) / 300.0 / kExposures;
      }
    }
  }
  // S (1 - (1-e)^N) (1-e), N = 300 rows, and 300 columns behind 3 of the prescan.
  const double rows = 2e4 * -std::expm1(300.0 * std::log1p(-2e-5));
  const double columns = 2e4 * -std::expm1(300.0 * std::log1p(-1e-5));
  std::printf("first overscan row %.2f of %.2f e-, first overscan column %.2f of %.2f e-\n", first_row, rows,
              first_column, columns);
  EXPECT_NEAR(first_row, rows, 0.03 * rows);
  EXPECT_NEAR(first_column, columns, 0.03 * columns);
}

TEST(Cti, ConservesChargeThroughTheFrame) {
  for (const CtiModel model : {CtiModel::kSimple, CtiModel::kTraps}) {
    Mission mission = flat(120, 3e3);
    mission.ccd.reference = {.prescan = 2, .serial_overscan = 4, .parallel_overscan = 4};
    mission.ccd.cti.model = model;
    mission.ccd.cti.parallel = mission.ccd.cti.serial = 1e-4;
    mission.ccd.cti.trap_density = {2.0, 1.0};
    mission.ccd.cti.register_density = {0.3, 0.3};
    mission.ccd.cti.trap_cross_section = {1e-20, 1e-22};
    mission.ccd.cti.trap_release_time = {1e-3, 1e-2};
    ChainRun run(mission, {{60.0, 60.0, 1e5}});
    double before = 0.0;
    double after = 0.0;
    run.simulator.simulate(2, run.state, [&](const EffectSpec& spec, const ExposureState& state) {
      double sum = 0.0;
      if (spec.name != "photon-noise" && spec.name != "cti") return;
      for (const double electrons : state.sampled.whole().pixels()) sum += electrons;
      (spec.name == "cti" ? after : before) = sum;
    });
    EXPECT_GT(run.state.lost_electrons, 0.0);
    EXPECT_NEAR((after + run.state.lost_electrons) / before, 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace astroid
