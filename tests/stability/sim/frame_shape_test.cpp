// Hard case N40: frames of one pixel, one row, one column; stars outside the frame.
#include <gtest/gtest.h>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

double expected_sum(const Mission& mission, const StarCatalogue& catalogue) {
  const auto scene = std::make_shared<const Scene>(mission, catalogue);
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(0, state);
  simulator.expect(0, state);
  double sum = 0.0;
  for (const double pixel : state.expected.whole().pixels()) sum += pixel;
  return sum;
}

TEST(FrameShape, OfOnePixelOneRowAndOneColumnWorks) {
  const StarCatalogue centred = test::lab_catalogue({{0.0, 0.0, 1000.0}});
  const double one = expected_sum(test::bare_mission(1, 1), centred);
  const double row = expected_sum(test::bare_mission(20, 1), centred);
  const double column = expected_sum(test::bare_mission(1, 20), centred);
  EXPECT_GT(one, 300.0);
  EXPECT_GT(row, one);
  EXPECT_DOUBLE_EQ(row, column);
}

TEST(FrameShape, LightOfAStarOutsideTheFrameSpillsIn) {
  const StarCatalogue inside = test::lab_catalogue({{16.0, 16.0, 1e4}});
  const StarCatalogue both = test::lab_catalogue({{16.0, 16.0, 1e4}, {-1.0, 16.0, 1e4}});
  const double spilled =
      expected_sum(test::bare_mission(32, 32), both) - expected_sum(test::bare_mission(32, 32), inside);
  // A Gaussian of 0.6 px one pixel beyond the edge at -0.5: half the light is outside 0 px, erfc(0.5/0.6/sqrt 2)/2
  // inside.
  EXPECT_NEAR(spilled, 1e4 * 0.5 * std::erfc(0.5 / 0.6 / std::sqrt(2.0)), 0.05);
}

TEST(FrameShape, StarOnTheEdgeKeepsItsNormalisation) {
  const double all = expected_sum(test::bare_mission(32, 32), test::lab_catalogue({{16.0, 16.0, 1e4}}));
  const double half = expected_sum(test::bare_mission(32, 32), test::lab_catalogue({{31.499, 16.0, 1e4}}));
  EXPECT_NEAR(all, 1e4, 0.01);
  EXPECT_NEAR(half / 1e4, 0.5, 0.01);
}

}  // namespace
}  // namespace astroid
