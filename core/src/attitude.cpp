#include "astroid/core/attitude.hpp"

namespace astroid {

PixelShift displacement(const AttitudeJacobian& jacobian, const Attitude& attitude) {
  return {jacobian.dx_dyaw * attitude.yaw + jacobian.dx_dpitch * attitude.pitch + jacobian.dx_droll * attitude.roll,
          jacobian.dy_dyaw * attitude.yaw + jacobian.dy_dpitch * attitude.pitch + jacobian.dy_droll * attitude.roll};
}

MotionCovariance motion_covariance(const AttitudeJacobian& j, const AttitudeCovariance& v) {
  // Covariance of (a . attitude) and (b . attitude) for rows a, b of the Jacobian.
  const auto product = [&v](const Attitude& a, const Attitude& b) {
    return a.yaw * b.yaw * v.yaw_yaw + a.pitch * b.pitch * v.pitch_pitch + a.roll * b.roll * v.roll_roll +
           (a.yaw * b.pitch + a.pitch * b.yaw) * v.yaw_pitch + (a.yaw * b.roll + a.roll * b.yaw) * v.yaw_roll +
           (a.pitch * b.roll + a.roll * b.pitch) * v.pitch_roll;
  };
  const Attitude x{j.dx_dyaw, j.dx_dpitch, j.dx_droll};
  const Attitude y{j.dy_dyaw, j.dy_dpitch, j.dy_droll};
  return {.sxx = product(x, x), .sxy = product(x, y), .syy = product(y, y)};
}

MotionCovariance motion_covariance(const AttitudeJacobian& jacobian, const AttitudeVariance& attitude) {
  return motion_covariance(
      jacobian, AttitudeCovariance{.yaw_yaw = attitude.yaw, .pitch_pitch = attitude.pitch, .roll_roll = attitude.roll});
}

}  // namespace astroid
