// Proper motion: the place of a star at another epoch.
#pragma once

#include "astroid/core/geometry.hpp"

namespace astroid {

/// Angular velocity, mas per Julian year.
struct ProperMotion {
  double ra = 0.0;  ///< times cos(dec)
  double dec = 0.0;
};

/// The place `years` later of a star that moves uniformly along a straight line, seen from the barycentre: the vector
/// u + (p pm_ra + q pm_dec) t, normalised, p and q pointing east and north. Rigorous at the poles and for any time;
/// without radial velocity (which changes the motion by 1e-5 a century for a star at 10 pc and 100 km/s) and without
/// parallax. No motion leaves the place bit for bit.
/// @source ESA1997 (vol. 1, 1.5.5)
SkyPosition moved(SkyPosition position, ProperMotion motion, double years);

/// Julian year of a Modified Julian Date (TDB).
double julian_year(double mjd);

}  // namespace astroid
