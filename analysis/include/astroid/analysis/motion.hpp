// How much a star moves on the detector, and what of that is left in a mean over time.
#pragma once

#include "astroid/core/geometry.hpp"
#include "astroid/core/mission.hpp"

namespace astroid {

/// The motion of one star: of its mean position in an exposure, and of the mean of that over a bin.
struct StarMotion {
  MotionCovariance exposure;
  MotionCovariance bin;
};

/// Covariance of the displacement in one camera, rows x and y, with that in another, columns; px².
struct CrossCovariance {
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
};

/// The motion of one star in two cameras, as StarMotion.
struct CrossMotion {
  CrossCovariance exposure;
  CrossCovariance bin;
};

/// Expected motion of a star by the mission's red-noise jitter, at a place `offset_x`, `offset_y` px from the optical
/// axis: yaw moves along x, pitch along y, roll around the axis, but for a camera that is tilted on the spacecraft
/// (F110). Exact for an Ornstein-Uhlenbeck process averaged over exposures and bins. Zero without jitter; for a jitter
/// file the pipeline takes the covariances from the file itself.
/// @source UhlenbeckOrnstein1930
StarMotion star_motion(const Mission& mission, double offset_x, double offset_y);

/// The same of a star on the axes of two cameras, whose exposures may begin at different times.
CrossMotion cross_motion(const Mission& a, const Mission& b);

/// The motion of a star in one camera, from what it is with itself.
StarMotion own_motion(const CrossMotion& motion);

/// Motion as noise of one exposure of one camera that would average out like pixel noise and leave as much in a bin:
/// all cameras move together, and slow motion stays. What GroundModel::motion wants.
/// @param bin                covariance of the mean displacement over a bin, px².
/// @param exposures_per_bin  and @param cameras over which pixel noise averages.
MotionCovariance motion_like_pixel_noise(const MotionCovariance& bin, double exposures_per_bin, int cameras);

}  // namespace astroid
