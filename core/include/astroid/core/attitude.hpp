// The attitude of a spacecraft as small angles, and how stars move with it.
#pragma once

#include "astroid/core/geometry.hpp"

namespace astroid {

/// How far a star moves on the detector when the spacecraft turns by a small angle; px per arcsec.
///
/// Yaw turns the camera about its own y axis, pitch about its x axis, roll about the optical axis; the signs are those
/// by which the *stars* move: on the axis yaw moves them by +1/scale along x and pitch by +1/scale along y, roll moves
/// them counter-clockwise, from +x to +y. For any projection and place in the field; to first order in the angles.
/// Where the camera is tilted on its spacecraft, the axes are those of a camera that looks along the spacecraft's
/// boresight (F110).
struct AttitudeJacobian {
  double dx_dyaw = 0.0;
  double dx_dpitch = 0.0;
  double dx_droll = 0.0;
  double dy_dyaw = 0.0;
  double dy_dpitch = 0.0;
  double dy_droll = 0.0;
};

/// The step to which the members of AttitudeJacobian are rounded, px/arcsec: hides the C library's last bits likewise.
inline constexpr double kJacobianGrid = 0x1p-32;

/// Deviation from the nominal pointing, arcsec.
struct Attitude {
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
};

/// Displacement of a star whose Jacobian is given. @returns px
PixelShift displacement(const AttitudeJacobian& jacobian, const Attitude& attitude);

/// Variance of yaw, pitch and roll, arcsec², where the axes are independent.
struct AttitudeVariance {
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
};

/// Covariance of yaw, pitch and roll, arcsec².
struct AttitudeCovariance {
  double yaw_yaw = 0.0, yaw_pitch = 0.0, yaw_roll = 0.0, pitch_pitch = 0.0, pitch_roll = 0.0, roll_roll = 0.0;
};

/// The covariance on the detector of a star whose Jacobian is given. @returns px²
MotionCovariance motion_covariance(const AttitudeJacobian& jacobian, const AttitudeCovariance& attitude);
MotionCovariance motion_covariance(const AttitudeJacobian& jacobian, const AttitudeVariance& attitude);

}  // namespace astroid
