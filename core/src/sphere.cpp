#include "astroid/core/sphere.hpp"

#include <cmath>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr double kFullTurn = 360.0;    // deg
constexpr double kQuarterTurn = 90.0;  // deg
constexpr double kHorizonCosine =
    1e-12;  // cosine of the distance from the tangent point below which x = tan is refused

// One direction seen from another: cosine of the separation, and components to the east and to the north of the unit
// vector, in forms that keep their relative accuracy when the two directions nearly agree.
struct RelativeDirection {
  double cosine;
  double east;
  double north;
};

RelativeDirection seen_from(SkyPosition origin, SkyPosition position) {
  const SineCosine dec0 = sine_cosine(Degrees(origin.dec));
  const SineCosine dec = sine_cosine(Degrees(position.dec));
  const SineCosine difference = sine_cosine(Degrees(position.dec - origin.dec));
  const double ra_difference = position.ra - origin.ra;
  const double half = sine_cosine(Degrees(0.5 * std::remainder(ra_difference, kFullTurn))).sine;
  // cos(ra difference) = 1 - 2 sin^2(half of it), so that what is left when the directions agree is small by itself.
  const double versine = 2.0 * half * half;
  return {difference.cosine - versine * dec.cosine * dec0.cosine, dec.cosine * sine_cosine(Degrees(ra_difference)).sine,
          difference.sine + versine * dec0.sine * dec.cosine};
}

}  // namespace

SineCosine sine_cosine(Degrees angle) {
  // Both steps are exact, so sines of multiples of 90 deg are, and 359 deg is as good as -1 deg.
  const double reduced = std::remainder(angle.value(), kFullTurn);
  const double quarter = std::nearbyint(reduced / kQuarterTurn);
  const double rest = to_radians(Degrees(reduced - quarter * kQuarterTurn)).value();
  const double sine = det::sin(rest);
  const double cosine = det::cos(rest);
  if (quarter == 0.0) return {sine, cosine};
  if (quarter == 1.0) return {cosine, -sine};
  if (quarter == -1.0) return {-cosine, sine};
  return {-sine, -cosine};
}

Direction to_direction(SkyPosition position) {
  const SineCosine ra = sine_cosine(Degrees(position.ra));
  const SineCosine dec = sine_cosine(Degrees(position.dec));
  return {dec.cosine * ra.cosine, dec.cosine * ra.sine, dec.sine};
}

Horizon horizon(SkyPosition place) {
  const SineCosine ra = sine_cosine(Degrees(place.ra));
  const SineCosine dec = sine_cosine(Degrees(place.dec));
  return {.east = {-ra.sine, ra.cosine, 0.0}, .north = {-dec.sine * ra.cosine, -dec.sine * ra.sine, dec.cosine}};
}

SkyPosition to_sky_position(Direction direction) {
  const double equatorial = det::hypot(direction.x, direction.y);
  const double ra = equatorial > 0.0 ? to_degrees(Radians(det::atan2(direction.y, direction.x))).value() : 0.0;
  return {wrap_degrees(ra), to_degrees(Radians(det::atan2(direction.z, equatorial))).value()};
}

double wrap_degrees(double angle) {
  const double remainder = std::fmod(angle, kFullTurn);
  const double wrapped = remainder < 0.0 ? remainder + kFullTurn : remainder;
  return wrapped >= kFullTurn ? 0.0 : wrapped + 0.0;
}

Degrees angular_separation(SkyPosition a, SkyPosition b) {
  const RelativeDirection relative = seen_from(a, b);
  return to_degrees(Radians(det::atan2(det::hypot(relative.east, relative.north), relative.cosine)));
}

std::optional<TangentPlanePoint> gnomonic(SkyPosition position, SkyPosition tangent) {
  const RelativeDirection relative = seen_from(tangent, position);
  if (!(relative.cosine > kHorizonCosine)) return std::nullopt;
  return TangentPlanePoint{to_degrees(Radians(relative.east / relative.cosine)).value(),
                           to_degrees(Radians(relative.north / relative.cosine)).value()};
}

SkyPosition inverse_gnomonic(TangentPlanePoint point, SkyPosition tangent) {
  if (point.xi == 0.0 && point.eta == 0.0) return tangent;
  const double xi = to_radians(Degrees(point.xi)).value();
  const double eta = to_radians(Degrees(point.eta)).value();
  const SineCosine dec0 = sine_cosine(Degrees(tangent.dec));
  // The vector tangent + xi * east + eta * north in the frame whose x axis has the tangent point's right ascension.
  const double forward = dec0.cosine - eta * dec0.sine;
  const double ra = to_degrees(Radians(det::atan2(xi, forward))).value();
  const double dec = to_degrees(Radians(det::atan2(dec0.sine + eta * dec0.cosine, det::hypot(forward, xi)))).value();
  return {wrap_degrees(tangent.ra + ra), dec};
}

}  // namespace astroid
