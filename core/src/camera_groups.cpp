#include "astroid/core/camera_groups.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

/// What a list says of a group; `otherwise` where it says nothing.
double of_group(const std::vector<double>& list, int group, double otherwise) {
  return list.empty() ? otherwise : list[static_cast<std::size_t>(group)];
}

int all_cameras(const CameraGroups& groups) {
  return std::accumulate(groups.cameras.begin(), groups.cameras.end(), 0);
}

}  // namespace

int group_count(const TelescopeSettings& telescope) {
  return std::max(1, static_cast<int>(telescope.groups.cameras.size()));
}

int cameras_in_turn(const TelescopeSettings& telescope) {
  const CameraGroups& groups = telescope.groups;
  if (groups.cameras.empty()) return 1;
  int common = 0;
  for (const int cameras : groups.cameras) common = std::gcd(common, cameras);
  return all_cameras(groups) / std::max(1, common);
}

int group_of_camera(const TelescopeSettings& telescope, int camera) {
  const CameraGroups& groups = telescope.groups;
  if (groups.cameras.empty()) return 0;
  const int turn = cameras_in_turn(telescope);
  const int turns = all_cameras(groups) / turn;
  int place = camera % turn;
  for (std::size_t g = 0; g < groups.cameras.size(); ++g) {
    place -= groups.cameras[g] / turns;
    if (place < 0) return static_cast<int>(g);
  }
  throw BugError("a camera of no group");
}

double group_share(const TelescopeSettings& telescope, int group) {
  const CameraGroups& groups = telescope.groups;
  if (groups.cameras.empty()) return 1.0;
  return static_cast<double>(groups.cameras[static_cast<std::size_t>(group)]) / all_cameras(groups);
}

Mission group_mission(const Mission& mission, int group) {
  const CameraGroups& groups = mission.telescope.groups;
  if (groups.cameras.empty()) return mission;
  Mission seen = mission;
  seen.telescope.group = group;
  seen.simulation.stagger = Seconds(of_group(groups.stagger, group, 0.0));
  seen.telescope.throughput.beginning_of_life *= of_group(groups.throughput, group, 1.0);
  seen.telescope.throughput.end_of_life = of_group(groups.end_of_life, group, mission.telescope.throughput.end_of_life);
  seen.ccd.axis_x += of_group(groups.offset_x, group, 0.0);
  seen.ccd.axis_y += of_group(groups.offset_y, group, 0.0);
  return seen;
}

Boresight spacecraft_boresight(const Mission& mission) {
  return {.axis = {mission.satellite.ra.value(), mission.satellite.dec.value()},
          .roll = mission.satellite.roll + mission.simulation.quarter * mission.satellite.repointing.turn};
}

Boresight camera_boresight(const Mission& mission) {
  Boresight boresight = spacecraft_boresight(mission);
  const int group = mission.telescope.group;
  if (group < 0) return boresight;
  const CameraGroups& groups = mission.telescope.groups;
  const double tilt = of_group(groups.tilt, group, 0.0);
  if (tilt != 0.0) boresight = tilted(boresight, Degrees(tilt), Degrees(of_group(groups.azimuth, group, 0.0)));
  const double roll = of_group(groups.roll, group, 0.0);
  if (roll != 0.0) boresight.roll = boresight.roll + Degrees(roll);
  return boresight;
}

}  // namespace astroid
