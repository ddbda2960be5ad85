#include "astroid/sim/aberration.hpp"

#include "astroid/core/ecliptic.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kArcsecPerRadian = 180.0 * 3600.0 / kPi;

/// Mean speed of the Earth over the speed of light, 20.49552 arcsec: n a / (c sqrt(1 - e²)).
constexpr double kAberrationConstant = 20.49552 / kArcsecPerRadian;
/// Distance of L2 from the Sun over the Earth's: 1 + (m/3)^(1/3), m = 3.0404e-6 of Earth and Moon.
constexpr double kLagrange2 = 1.01004;

}  // namespace

Velocity spacecraft_velocity(double mjd) {
  const EarthPlace earth = earth_place(mjd);
  const double speed = kLagrange2 * kAberrationConstant;
  const double longitude = earth.longitude.value();
  const double perihelion = earth.perihelion.value();
  const double vx = -speed * (det::sin(longitude) + earth.eccentricity * det::sin(perihelion));
  const double vy = speed * (det::cos(longitude) + earth.eccentricity * det::cos(perihelion));
  const SineCosine obliquity = sine_cosine(kObliquity);
  return {vx, vy * obliquity.cosine, vy * obliquity.sine};
}

Velocity velocity_since_start(const SimulationSettings& simulation, Seconds time) {
  const Velocity at_start = spacecraft_velocity(simulation.start_mjd);
  Velocity v = spacecraft_velocity(simulation.start_mjd + time.value() / kSecondsPerDay);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] -= at_start[i];
  return v;
}

AberrationJacobian aberration_jacobian(SkyPosition star, const Boresight& boresight, const AttitudeJacobian& motion) {
  const Direction n = to_direction(star);
  const CameraAxes axes = camera_axes(boresight);
  const Direction& b = axes.axis;
  const double cosine = dot(n, b);
  AberrationJacobian jacobian;
  if (!(cosine > 0.0)) return jacobian;
  const double apart = 1.0 - dot(n, b);
  const std::array<double, 3> along_star{n.x, n.y, n.z};
  for (std::size_t i = 0; i < jacobian.x.size(); ++i) {
    Direction shift{-along_star[i] * (n.x - b.x), -along_star[i] * (n.y - b.y), -along_star[i] * (n.z - b.z)};
    (i == 0 ? shift.x : (i == 1 ? shift.y : shift.z)) += apart;
    // The yaw and pitch that would move this star as far: they move it by their angle times the cosine.
    const double yaw = kArcsecPerRadian * dot(shift, axes.x) / cosine;
    const double pitch = kArcsecPerRadian * dot(shift, axes.y) / cosine;
    jacobian.x[i] = motion.dx_dyaw * yaw + motion.dx_dpitch * pitch;
    jacobian.y[i] = motion.dy_dyaw * yaw + motion.dy_dpitch * pitch;
  }
  return jacobian;
}

}  // namespace astroid
