// Which camera belongs to which group, and what its group makes of the mission.
#include "astroid/core/camera_groups.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace astroid {
namespace {

Mission mission_of(const std::vector<int>& cameras) {
  Mission mission;
  mission.satellite.ra = Degrees(95.3104);
  mission.satellite.dec = Degrees(-47.8869);
  mission.satellite.roll = Degrees(20.0);
  mission.telescope.groups.cameras = cameras;
  mission.telescope.cameras = 0;
  for (const int n : cameras) mission.telescope.cameras += n;
  return mission;
}

std::vector<int> groups_of_first(const Mission& mission, int count) {
  std::vector<int> groups;
  for (int camera = 0; camera < count; ++camera) groups.push_back(group_of_camera(mission.telescope, camera));
  return groups;
}

TEST(CameraGroups, TakeTurnsInTheNumberingOfCameras) {
  const Mission equal = mission_of({6, 6, 6, 6});
  EXPECT_EQ(cameras_in_turn(equal.telescope), 4);
  EXPECT_EQ(groups_of_first(equal, 8), (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 3}));
  const Mission unequal = mission_of({12, 6});
  EXPECT_EQ(cameras_in_turn(unequal.telescope), 3);
  EXPECT_EQ(groups_of_first(unequal, 6), (std::vector<int>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(groups_of_first(Mission{}, 3), (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(cameras_in_turn(Mission{}.telescope), 1);
}

TEST(CameraGroups, OfAnyNumberOfTurnsHaveTheirShareOfTheCameras) {
  const Mission mission = mission_of({2, 4, 6});
  for (int count = cameras_in_turn(mission.telescope); count <= 12; count += cameras_in_turn(mission.telescope))
    for (int g = 0; g < 3; ++g) {
      int cameras = 0;
      for (const int group : groups_of_first(mission, count)) cameras += group == g ? 1 : 0;
      EXPECT_DOUBLE_EQ(static_cast<double>(cameras) / count, group_share(mission.telescope, g)) << count;
    }
}

TEST(CameraGroups, MakeNothingOfAMissionWithoutThem) {
  const Mission mission;
  EXPECT_EQ(group_mission(mission, 0), mission);
}

TEST(CameraGroups, ChangeTimePhaseAndThroughputOfTheMission) {
  Mission mission = mission_of({1, 1});
  mission.ccd.axis_x = 10.0;
  mission.telescope.throughput = {.beginning_of_life = 0.9, .end_of_life = 0.8};
  mission.telescope.groups.stagger = {0.0, 6.25};
  mission.telescope.groups.offset_x = {0.0, 0.25};
  mission.telescope.groups.offset_y = {0.0, -0.5};
  mission.telescope.groups.throughput = {1.0, 0.5};
  mission.telescope.groups.end_of_life = {0.7, 0.6};
  const Mission second = group_mission(mission, 1);
  EXPECT_EQ(second.simulation.stagger, Seconds(6.25));
  EXPECT_EQ(second.ccd.axis_x, 10.25);
  EXPECT_EQ(second.ccd.axis_y, -0.5);
  EXPECT_EQ(second.telescope.throughput.beginning_of_life, 0.45);
  EXPECT_EQ(second.telescope.throughput.end_of_life, 0.6);
  EXPECT_EQ(second.telescope.cameras, 2);
}

TEST(CameraGroups, WithoutATiltLookAlongTheSpacecraftsBoresightToTheBit) {
  Mission mission = mission_of({1, 1});
  mission.telescope.groups.tilt = {0.0, 0.0};
  const Boresight camera = camera_boresight(group_mission(mission, 1));
  EXPECT_EQ(camera.axis.ra, mission.satellite.ra.value());
  EXPECT_EQ(camera.axis.dec, mission.satellite.dec.value());
  EXPECT_EQ(camera.roll, mission.satellite.roll);
}

TEST(Boresight, IsTiltedByTheAngleTowardsTheAzimuthWithoutATurnOnTheWay) {
  for (const SkyPosition place : {SkyPosition{95.3104, -47.8869}, SkyPosition{10.0, 89.9}, SkyPosition{359.9, 0.0}})
    for (const double roll : {0.0, 20.0, -130.0})
      for (const double azimuth : {0.0, 45.0, 200.0}) {
        constexpr double kTilt = 9.2;
        const Boresight from{.axis = place, .roll = Degrees(roll)};
        const CameraAxes before = camera_axes(from);
        const CameraAxes after = camera_axes(tilted(from, Degrees(kTilt), Degrees(azimuth)));
        const double theta = to_radians(Degrees(kTilt)).value();
        const double phi = to_radians(Degrees(azimuth)).value();
        EXPECT_NEAR(dot(after.axis, before.axis), std::cos(theta), 1e-14);
        EXPECT_NEAR(dot(after.axis, before.x), std::sin(theta) * std::cos(phi), 1e-13);
        EXPECT_NEAR(dot(after.axis, before.y), std::sin(theta) * std::sin(phi), 1e-13);
        // Rodrigues' matrix of the turn by theta about the direction across: symmetric in x and y.
        EXPECT_NEAR(dot(after.x, before.y), dot(after.y, before.x), 1e-13);
        EXPECT_NEAR(dot(after.x, before.x), 1.0 - (1.0 - std::cos(theta)) * std::cos(phi) * std::cos(phi), 1e-13);
        EXPECT_NEAR(dot(after.x, before.axis), -std::sin(theta) * std::cos(phi), 1e-13);
      }
}

}  // namespace
}  // namespace astroid
