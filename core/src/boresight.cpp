#include "astroid/core/boresight.hpp"

#include "astroid/core/math.hpp"

namespace astroid {

CameraAxes camera_axes(const Boresight& boresight) {
  const auto [east, north] = horizon(boresight.axis);
  const SineCosine roll = sine_cosine(boresight.roll);
  // CD = scale [-cos -sin; -sin cos] (CameraPointing).
  return {.x = combine(-roll.cosine, east, -roll.sine, north),
          .y = combine(-roll.sine, east, roll.cosine, north),
          .axis = to_direction(boresight.axis)};
}

Boresight tilted(const Boresight& boresight, Degrees tilt, Degrees azimuth) {
  const CameraAxes before = camera_axes(boresight);
  const SineCosine phi = sine_cosine(azimuth);
  const SineCosine theta = sine_cosine(tilt);
  const Direction towards = combine(phi.cosine, before.x, phi.sine, before.y);
  const Direction across = combine(-phi.sine, before.x, phi.cosine, before.y);  // which the tilt leaves as it is
  const SkyPosition axis = to_sky_position(combine(theta.cosine, before.axis, theta.sine, towards));
  const Direction x = combine(phi.cosine, combine(theta.cosine, towards, -theta.sine, before.axis), -phi.sine, across);
  const auto [east, north] = horizon(axis);
  return {.axis = axis, .roll = to_degrees(Radians(det::atan2(-dot(x, north), -dot(x, east))))};
}

}  // namespace astroid
