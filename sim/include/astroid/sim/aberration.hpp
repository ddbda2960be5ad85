// Kinematic aberration: stars move in the field while the velocity of the spacecraft turns with the Earth.
#pragma once

#include <array>

#include "astroid/core/geometry.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/units.hpp"
#include "astroid/core/wcs.hpp"

namespace astroid {

/// A velocity in units of the speed of light, ICRS.
using Velocity = std::array<double, 3>;

/// Velocity of a spacecraft that stays at the second Lagrange point, about the Sun: 1.01 of the Earth's.
///
/// Keplerian, from the mean elements of the orbit of the Earth and Moon. A halo orbit's own 0.1 … 0.3 km/s is not in
/// it.
/// @param mjd  TDB, 1800 … 2050.  @accuracy 1e-3 of the speed: the Sun's own motion, and the Earth's about the Moon's
/// and its centre of mass (test: Aberration.VelocityIsTheDerivativeOfAKeplerOrbit)
/// @source Standish1992
Velocity spacecraft_velocity(double mjd);

/// How that has changed since the start of a run, to which catalogued places belong.  @param time  since the start
Velocity velocity_since_start(const SimulationSettings& simulation, Seconds time);

/// Displacement of a star on the detector by one unit of velocity along each axis of ICRS; px.
struct AberrationJacobian {
  Velocity x{};
  Velocity y{};
  [[nodiscard]] PixelShift displacement(const Velocity& v) const {
    return {x[0] * v[0] + x[1] * v[1] + x[2] * v[2], y[0] * v[0] + y[1] * v[1] + y[2] * v[2]};
  }
};

/// Differential aberration of a star, where the attitude control holds the apparent place of the boresight and turns
/// about no other axis: with n the star, b the boresight and v the velocity, v (1 - n·b) - (n·v)(n - b).
///
/// First order in v: what is left out is v² = 1e-8 of the distance to the boresight.
/// @param star       direction without aberration.
/// @param boresight  of the spacecraft; the camera's axis may be another.
/// @param motion     of the star: how its pixel answers to small rotations about the spacecraft's axes.
/// @returns zero for a star 90 deg or more from the boresight.
/// @source Kovalevsky2004
AberrationJacobian aberration_jacobian(SkyPosition star, const Boresight& boresight, const AttitudeJacobian& motion);

}  // namespace astroid
