#include "astroid/sim/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

Plan plan_of(const Mission& mission, const StarCatalogue& catalogue) {
  return make_plan(Scene(mission, catalogue));
}

TEST(Plan, RunsOnlyWhatTheSceneCallsFor) {
  const StarCatalogue faint = test::lab_catalogue({{16.0, 16.0, 1e4}});
  const Plan bare = plan_of(test::bare_mission(32, 32), faint);
  for (const char* off :
       {"jitter-model", "jitter-file", "sky", "prnu", "dark-current", "full-well", "readout-noise", "bias"})
    EXPECT_FALSE(bare.runs(off)) << off;
  for (const char* on : {"stars", "photon-noise", "gain", "adc"}) EXPECT_TRUE(bare.runs(on)) << on;
  EXPECT_TRUE(bare.still);

  const Plan plato = plan_of(test::plato_mission(32, 32), faint);
  for (const char* on : {"jitter-model", "sky", "prnu", "dark-current", "readout-noise", "bias"})
    EXPECT_TRUE(plato.runs(on)) << on;
  EXPECT_FALSE(plato.runs("full-well"));
}

TEST(Plan, SwitchesSaturationOnForABrightStarOnly) {
  EXPECT_FALSE(plan_of(test::plato_mission(32, 32), test::lab_catalogue({{16.0, 16.0, 1e6}})).runs("full-well"));
  EXPECT_TRUE(plan_of(test::plato_mission(32, 32), test::lab_catalogue({{16.0, 16.0, 3e6}})).runs("full-well"));
}

TEST(Plan, DecidesOnTheFullFrame) {
  const StarCatalogue catalogue = test::lab_catalogue({{16.0, 16.0, 1e4}, {100.0, 100.0, 1e7}});
  Mission mission = test::plato_mission(128, 128);
  mission.ccd.has_sub_field = true;
  mission.ccd.sub_columns = mission.ccd.sub_rows = 32;
  EXPECT_TRUE(plan_of(mission, catalogue).runs("full-well"));
}

TEST(Plan, GivesBrighterStarsLargerStamps) {
  const Plan plan = plan_of(test::plato_mission(64, 64), test::lab_catalogue({{16.0, 16.0, 1e3}, {40.0, 40.0, 1e7}}));
  EXPECT_GT(plan.knobs.stamp_half_width(1e7), plan.knobs.stamp_half_width(1e3));
  Mission sloppy = test::plato_mission(64, 64);
  sloppy.simulation.accuracy = Ppm(1e4);
  const Plan rough = plan_of(sloppy, test::lab_catalogue({{16.0, 16.0, 1e3}, {40.0, 40.0, 1e7}}));
  EXPECT_LT(rough.knobs.stamp_half_width(1e7), plan.knobs.stamp_half_width(1e7));
}

TEST(Plan, TreatsStrongerJitterMoreCarefully) {
  Mission mission = test::plato_mission(32, 32);
  const StarCatalogue catalogue = test::lab_catalogue({{16.0, 16.0, 1e6}});
  EXPECT_EQ(plan_of(mission, catalogue).knobs.jitter, JitterTreatment::kShift);
  mission.simulation.accuracy = Ppm(0.1);
  EXPECT_EQ(plan_of(mission, catalogue).knobs.jitter, JitterTreatment::kBroadened);
  mission.satellite.jitter.yaw = Arcseconds(3.0);
  mission.satellite.jitter.timescale = Seconds(5.0);
  const Plan plan = plan_of(mission, catalogue);
  EXPECT_EQ(plan.knobs.jitter, JitterTreatment::kSubSteps);
  EXPECT_GT(plan.knobs.attitude_steps, 10);
}

TEST(Plan, ExplainsItselfInWordsAndAsJson) {
  const Scene scene(test::plato_mission(32, 32), test::lab_catalogue({{16.0, 16.0, 1e5}}));
  const Plan plan = make_plan(scene);
  const std::string text = to_text(plan, scene);
  EXPECT_THAT(text, testing::HasSubstr("full frame of 32 x 32 px"));
  EXPECT_THAT(text, testing::HasSubstr("readout-noise"));
  EXPECT_THAT(text, testing::HasSubstr("full well"));
  EXPECT_THAT(to_json(plan, scene), testing::HasSubstr("\"name\": \"photon-noise\""));
}

}  // namespace
}  // namespace astroid
