// Where a camera looks, how it is rolled, and the directions in which its axes point.
#pragma once

#include "astroid/core/geometry.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// A direction and how a camera that looks there is rolled about it, in the sense of CameraPointing.
struct Boresight {
  SkyPosition axis{};  ///< ICRS
  Degrees roll{};
};

/// The directions in which x and y grow in a camera that looks along a boresight, and the boresight: unit vectors at
/// right angles to each other. Left-handed: seen from inside, the sky is a mirror image.
struct CameraAxes {
  Direction x, y, axis;
};
[[nodiscard]] CameraAxes camera_axes(const Boresight& boresight);

/// A boresight carried along a great circle, and not turned about itself on the way (F110).
/// @param tilt     the way.
/// @param azimuth  its direction, from +x to +y of the camera before.
[[nodiscard]] Boresight tilted(const Boresight& boresight, Degrees tilt, Degrees azimuth);

}  // namespace astroid
