// Where the Sun stands, and ecliptic and galactic coordinates.
#pragma once

#include "astroid/core/geometry.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// Obliquity of the ecliptic of J2000. @source Standish1992
inline constexpr Degrees kObliquity{23.43928};

/// The Earth about the Sun, in the ecliptic of J2000: mean elements of the Earth-Moon barycentre.
struct EarthPlace {
  Radians longitude;      ///< heliocentric
  Radians perihelion;     ///< longitude of the perihelion
  double eccentricity{};  ///< of the orbit
};
/// @param mjd  TDB, 1800 … 2050.  @accuracy 2e-5 rad, and the Earth's 3e-5 rad about the barycentre
/// @source Standish1992
[[nodiscard]] EarthPlace earth_place(double mjd);

/// A direction in another spherical system: longitude 0 … 360, latitude -90 … 90.
struct SphericalPosition {
  Degrees longitude, latitude;
};
/// Ecliptic of J2000.
[[nodiscard]] SphericalPosition to_ecliptic(SkyPosition position);
/// Galactic coordinates. @source ESA1997 (vol. 1, 1.5.3)
[[nodiscard]] SphericalPosition to_galactic(SkyPosition position);

}  // namespace astroid
