#include "astroid/core/boresight.hpp"

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

Direction sum(double a, const Direction& u, double b, const Direction& v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}

/// East and north at a place.
struct Horizon {
  Direction east, north;
};
Horizon horizon(SkyPosition place) {
  const SineCosine ra = sine_cosine(Degrees(place.ra));
  const SineCosine dec = sine_cosine(Degrees(place.dec));
  return {.east = {-ra.sine, ra.cosine, 0.0}, .north = {-dec.sine * ra.cosine, -dec.sine * ra.sine, dec.cosine}};
}

}  // namespace

CameraAxes camera_axes(const Boresight& boresight) {
  const auto [east, north] = horizon(boresight.axis);
  const SineCosine roll = sine_cosine(boresight.roll);
  // CD = scale [-cos -sin; -sin cos] (CameraPointing).
  return {.x = sum(-roll.cosine, east, -roll.sine, north),
          .y = sum(-roll.sine, east, roll.cosine, north),
          .axis = to_direction(boresight.axis)};
}

Boresight tilted(const Boresight& boresight, Degrees tilt, Degrees azimuth) {
  const CameraAxes before = camera_axes(boresight);
  const SineCosine phi = sine_cosine(azimuth);
  const SineCosine theta = sine_cosine(tilt);
  const Direction towards = sum(phi.cosine, before.x, phi.sine, before.y);
  const Direction across = sum(-phi.sine, before.x, phi.cosine, before.y);  // which the tilt leaves as it is
  const SkyPosition axis = to_sky_position(sum(theta.cosine, before.axis, theta.sine, towards));
  const Direction x = sum(phi.cosine, sum(theta.cosine, towards, -theta.sine, before.axis), -phi.sine, across);
  const auto [east, north] = horizon(axis);
  return {.axis = axis, .roll = to_degrees(Radians(det::atan2(-dot(x, north), -dot(x, east))))};
}

}  // namespace astroid
