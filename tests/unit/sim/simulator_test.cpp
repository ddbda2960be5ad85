#include "astroid/sim/simulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/noise.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

Simulator make_simulator(const Mission& mission, const StarCatalogue& catalogue) {
  const auto scene = std::make_shared<const Scene>(mission, catalogue);
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  return {scene, plan, 0};
}

std::vector<test::LabStar> crowd() {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < 40; ++i)
    stars.push_back({7.3 + 1.37 * i, 60.0 - 1.21 * i + 3.0 * std::sin(i), 2000.0 * std::exp(0.15 * i)});
  return stars;
}

std::vector<float> counts_of(const Simulator& simulator, std::int64_t exposure) {
  ExposureState state = simulator.make_state();
  simulator.simulate(exposure, state);
  const auto pixels = state.frame.pixels.pixels();
  return {pixels.begin(), pixels.end()};
}

TEST(Simulator, GivesTheSameBitsWhateverTheStateHeldBefore) {
  const Simulator simulator = make_simulator(test::plato_mission(64, 64), test::lab_catalogue(crowd()));
  ExposureState used = simulator.make_state();
  simulator.simulate(3, used);
  simulator.simulate(1, used);
  const auto again = used.frame.pixels.pixels();
  EXPECT_TRUE(std::ranges::equal(counts_of(simulator, 1), again));
}

TEST(Simulator, WindowEqualsFullFrame) {
  const StarCatalogue catalogue = test::lab_catalogue(crowd());
  const Mission full = test::plato_mission(64, 64);
  Mission sub = full;
  sub.ccd.has_sub_field = true;
  sub.ccd.sub_x0 = 13;
  sub.ccd.sub_y0 = 22;
  sub.ccd.sub_columns = 19;
  sub.ccd.sub_rows = 11;
  Mission windows = full;
  windows.ccd.window = 7;
  const Simulator whole = make_simulator(full, catalogue);
  for (const Mission& part : {sub, windows}) {
    const Simulator simulator = make_simulator(part, catalogue);
    ExposureState expected = whole.make_state();
    ExposureState state = simulator.make_state();
    whole.simulate(2, expected);
    simulator.simulate(2, state);
    std::size_t compared = 0;
    for (std::size_t r = 0; r < simulator.scene().layout()->regions().size(); ++r) {
      const Rectangle area = simulator.scene().layout()->regions()[r];
      for (int y = area.y0; y < area.y1(); ++y)
        for (int x = area.x0; x < area.x1(); ++x, ++compared)
          ASSERT_EQ(state.frame.pixels.view(r).at(x, y), expected.frame.pixels.view(0).at(x, y)) << x << "," << y;
    }
    EXPECT_GT(compared, 200U);
  }
}

TEST(Simulator, EffectOnOffLeavesOtherDrawsAlone) {
  const StarCatalogue catalogue = test::lab_catalogue(crowd());
  Mission with = test::plato_mission(32, 32);
  with.satellite.jitter.model = JitterModel::kNone;
  Mission without = with;
  without.ccd.prnu = 0.0;
  std::vector<double> noise[2];
  int which = 0;
  for (const Mission& mission : {with, without}) {
    const Simulator simulator = make_simulator(mission, catalogue);
    EXPECT_EQ(simulator.plan().runs("prnu"), which == 0);
    ExposureState state = simulator.make_state();
    std::vector<double> before;
    simulator.simulate(1, state, [&](const EffectSpec& effect, const ExposureState& s) {
      if (effect.name == "photon-noise")
        before.assign(s.sampled.whole().pixels().begin(), s.sampled.whole().pixels().end());
      if (effect.name == "readout-noise")
        for (std::size_t i = 0; i < before.size(); ++i)
          noise[which].push_back(s.sampled.whole().pixels()[i] - before[i]);
    });
    ++which;
  }
  ASSERT_EQ(noise[0].size(), 1024U);
  // The draws are the same; their sum with different electrons differs in the last bit only.
  for (std::size_t i = 0; i < noise[0].size(); ++i) ASSERT_NEAR(noise[0][i], noise[1][i], 1e-9);
}

TEST(Simulator, AddingAStarLeavesOtherStarsAlone) {
  std::vector<test::LabStar> stars{{10.2, 10.4, 5000.0}};
  const Simulator alone = make_simulator(test::plato_mission(64, 64), test::lab_catalogue(stars));
  stars.push_back({50.7, 51.3, 4000.0});
  const Simulator both = make_simulator(test::plato_mission(64, 64), test::lab_catalogue(stars));
  ExposureState a = alone.make_state();
  ExposureState b = both.make_state();
  alone.simulate(0, a);
  both.simulate(0, b);
  int different = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool same = a.frame.pixels.view(0).at(x, y) == b.frame.pixels.view(0).at(x, y);
      EXPECT_TRUE(same || (x >= 40 && y >= 40)) << x << "," << y;
      different += same ? 0 : 1;
    }
  EXPECT_GT(different, 4);
}

TEST(Simulator, LongerRunBeginsWithTheShorterOne) {
  Mission mission = test::plato_mission(32, 32);
  const StarCatalogue catalogue = test::lab_catalogue({{15.3, 16.2, 1e5}});
  const Simulator brief = make_simulator(mission, catalogue);
  mission.simulation.exposures = 40;
  const Simulator longer = make_simulator(mission, catalogue);
  for (int exposure = 0; exposure < 4; ++exposure) EXPECT_EQ(counts_of(brief, exposure), counts_of(longer, exposure));
  EXPECT_NE(counts_of(longer, 4), counts_of(longer, 5));
}

TEST(Simulator, CamerasShareTheAttitudeAndNothingElse) {
  const Mission mission = test::plato_mission(32, 32);
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{15.3, 16.2, 1e5}}));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  const Simulator first(scene, plan, 0);
  const Simulator second(scene, plan, 1);
  ExposureState a = first.make_state();
  ExposureState b = second.make_state();
  first.simulate(2, a);
  second.simulate(2, b);
  EXPECT_EQ(a.attitude.mean.yaw, b.attitude.mean.yaw);
  EXPECT_NE(a.attitude.mean.yaw, 0.0);
  EXPECT_FALSE(std::ranges::equal(a.frame.pixels.pixels(), b.frame.pixels.pixels()));
}

TEST(Simulator, CachesTheImageWhenNothingMoves) {
  Mission mission = test::plato_mission(32, 32);
  mission.satellite.jitter.model = JitterModel::kNone;
  const Simulator simulator = make_simulator(mission, test::lab_catalogue({{15.3, 16.2, 1e5}}));
  EXPECT_TRUE(simulator.plan().still);
  ExposureState cached = simulator.make_state();
  ExposureState observed = simulator.make_state();
  simulator.simulate(1, cached);
  simulator.simulate(1, observed, [](const EffectSpec&, const ExposureState&) {});
  EXPECT_TRUE(std::ranges::equal(cached.frame.pixels.pixels(), observed.frame.pixels.pixels()));
}

}  // namespace
}  // namespace astroid
