// Groups of cameras: each sees the mission with an optical axis, a pixel phase, a time and a throughput of its own.
#pragma once

#include "astroid/core/boresight.hpp"
#include "astroid/core/mission.hpp"

namespace astroid {

/// Groups of a mission; 1 where all cameras are alike.
int group_count(const TelescopeSettings& telescope);

/// The group of a camera, both from 0. Cameras are numbered so that the first n of them hold the same share of every
/// group, for every n that allows it: of 4 groups of 6 in turn one of each. A run with more cameras begins with the one
/// with fewer.
int group_of_camera(const TelescopeSettings& telescope, int camera);

/// The least number of cameras that hold the same share of every group; simulated are a multiple of it.
int cameras_in_turn(const TelescopeSettings& telescope);

/// Cameras of a group over all cameras: its weight in their mean.
double group_share(const TelescopeSettings& telescope, int group);

/// The mission as the cameras of one group see it: stagger, throughput and the pixel of the axis are theirs, and
/// camera_boresight() is. Numbers of cameras stay those of the mission. The mission itself where it has no groups.
Mission group_mission(const Mission& mission, int group);

/// Where the spacecraft points.
Boresight spacecraft_boresight(const Mission& mission);

/// Where the cameras of a mission point: the spacecraft's boresight turned by the group's tilt along a great circle
/// towards its azimuth, which is counted from +x to +y of a camera that looks along the spacecraft's boresight, then by
/// the group's roll about the axis that results. The spacecraft's boresight, to the bit, where nothing is tilted.
Boresight camera_boresight(const Mission& mission);

}  // namespace astroid
