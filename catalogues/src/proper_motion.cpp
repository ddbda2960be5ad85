#include "astroid/catalogues/proper_motion.hpp"

#include "astroid/core/sphere.hpp"

namespace astroid {

SkyPosition moved(SkyPosition position, ProperMotion motion, double years) {
  if ((motion.ra == 0.0 && motion.dec == 0.0) || years == 0.0) return position;
  constexpr double kRadiansPerMas = kPi / (180.0 * 3600.0 * 1000.0);
  const double east = kRadiansPerMas * motion.ra * years;
  const double north = kRadiansPerMas * motion.dec * years;
  const SineCosine ra = sine_cosine(Degrees(position.ra));
  const SineCosine dec = sine_cosine(Degrees(position.dec));
  const Direction u = to_direction(position);
  return to_sky_position({u.x - ra.sine * east - dec.sine * ra.cosine * north,
                          u.y + ra.cosine * east - dec.sine * ra.sine * north, u.z + dec.cosine * north});
}

double julian_year(double mjd) {
  constexpr double kJ2000 = 51544.5;
  constexpr double kDaysPerYear = 365.25;
  return 2000.0 + (mjd - kJ2000) / kDaysPerYear;
}

}  // namespace astroid
