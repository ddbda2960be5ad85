#include "astroid/core/ecliptic.hpp"

#include "astroid/core/math.hpp"
#include "astroid/core/sphere.hpp"

namespace astroid {

namespace {

constexpr double kRadian = kPi / 180.0;  // of a degree
// Mean elements of the Earth-Moon barycentre, valid 1800 - 2050. @source Standish1992
constexpr double kEccentricity = 0.01671123;
constexpr double kMeanLongitude = 100.46457166;        // deg at J2000
constexpr double kMeanLongitudeRate = 35999.37244981;  // deg per century
constexpr double kPerihelion = 102.93768193;           // deg
constexpr double kPerihelionRate = 0.32327364;         // deg per century
constexpr double kJ2000 = 51544.5;                     // MJD
constexpr double kDaysPerCentury = 36525.0;

/// Longitude and latitude about a pole; the longitude counts from `origin`, the longitude of the celestial pole.
SphericalPosition about(SkyPosition position, SkyPosition pole, double origin) {
  const SineCosine dec = sine_cosine(Degrees(position.dec));
  const SineCosine pole_dec = sine_cosine(Degrees(pole.dec));
  const SineCosine apart = sine_cosine(Degrees(position.ra - pole.ra));
  const double sine = dec.sine * pole_dec.sine + dec.cosine * pole_dec.cosine * apart.cosine;
  const double y = dec.cosine * apart.sine;
  const double x = dec.sine * pole_dec.cosine - dec.cosine * pole_dec.sine * apart.cosine;
  const double latitude = det::atan2(sine, det::hypot(x, y)) / kRadian;
  return {Degrees(wrap_degrees(origin - det::atan2(y, x) / kRadian)), Degrees(latitude)};
}

}  // namespace

EarthPlace earth_place(double mjd) {
  const double centuries = (mjd - kJ2000) / kDaysPerCentury;
  const double perihelion = kRadian * (kPerihelion + kPerihelionRate * centuries);
  const double anomaly = kRadian * (kMeanLongitude + kMeanLongitudeRate * centuries) - perihelion;
  // Equation of the centre to e²; the next term is 1e-5 rad.
  const double centre =
      2.0 * kEccentricity * det::sin(anomaly) + 1.25 * kEccentricity * kEccentricity * det::sin(2.0 * anomaly);
  return {Radians(perihelion + anomaly + centre), Radians(perihelion), kEccentricity};
}

SphericalPosition to_ecliptic(SkyPosition position) {
  return about(position, {270.0, 90.0 - kObliquity.value()}, 90.0);
}

SphericalPosition to_galactic(SkyPosition position) {
  constexpr SkyPosition kPole{192.85948, 27.12825};
  constexpr double kCelestialPole = 122.93192;  // its galactic longitude, deg
  return about(position, kPole, kCelestialPole);
}

}  // namespace astroid
