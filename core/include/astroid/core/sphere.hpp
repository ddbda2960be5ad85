// Directions on the sky: unit vectors, separations, the gnomonic projection. Same bits on every processor.
#pragma once

#include <optional>

#include "astroid/core/geometry.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// A direction as a unit vector: x towards (ra, dec) = (0, 0), z towards the north pole.
struct Direction {
  double x = 1.0;
  double y = 0.0;
  double z = 0.0;
};

[[nodiscard]] inline double dot(const Direction& a, const Direction& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// a u + b v.
[[nodiscard]] inline Direction combine(double a, const Direction& u, double b, const Direction& v) {
  return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}

struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

/// Sine and cosine of an angle in degrees. @accuracy 2 ulp; exact at multiples of 90 deg; the angle may be any finite
/// one.
[[nodiscard]] SineCosine sine_cosine(Degrees angle);

[[nodiscard]] Direction to_direction(SkyPosition position);

/// The unit vectors towards east and north at a place of the sky.
struct Horizon {
  Direction east, north;
};
[[nodiscard]] Horizon horizon(SkyPosition place);

/// @param direction  of any length but 0.  @returns ra in [0, 360), 0 at the poles of a vector with x = y = 0.
[[nodiscard]] SkyPosition to_sky_position(Direction direction);

/// The angle brought to [0, 360) without rounding, but for tiny negative ones, which become 0.
[[nodiscard]] double wrap_degrees(double angle);

/// Great-circle distance, 0 .. 180 deg.
///
/// Vincenty's arctangent of half-angle differences: no cancellation, whatever the separation.
/// @accuracy 1e-15 relative for given differences of coordinates; 180 deg to 1e-15 rad at the antipode (N5).
[[nodiscard]] Degrees angular_separation(SkyPosition a, SkyPosition b);

/// A point of the plane that touches the sky at a tangent point, in degrees: xi to the east, eta to the north.
struct TangentPlanePoint {
  double xi = 0.0;
  double eta = 0.0;
};

/// Gnomonic projection; nothing at or behind the horizon of the tangent point (N3).
/// @accuracy 2 ulp at 1 deg on the equator; 1e-15 relative to the distance from the tangent point in general.
[[nodiscard]] std::optional<TangentPlanePoint> gnomonic(SkyPosition position, SkyPosition tangent);

/// The direction that gnomonic() maps to the point; exactly the tangent point for (0, 0) (N4).
[[nodiscard]] SkyPosition inverse_gnomonic(TangentPlanePoint point, SkyPosition tangent);

}  // namespace astroid
