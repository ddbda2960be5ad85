#include "astroid/photometry/attitude_response.hpp"

namespace astroid {

namespace {

/// Relative change of a flux by its correction.
double correction(const AttitudeResponse& response, const Attitude& attitude) {
  const double change = response.yaw * attitude.yaw + response.pitch * attitude.pitch + response.roll * attitude.roll;
  return change * (0.5 * change - 1.0);
}

}  // namespace

AttitudeResponse attitude_response(const StarEstimator& estimator, const AttitudeJacobian& j) {
  const double x = estimator.gradient_x;
  const double y = estimator.gradient_y;
  return {.yaw = x * j.dx_dyaw + y * j.dy_dyaw,
          .pitch = x * j.dx_dpitch + y * j.dy_dpitch,
          .roll = x * j.dx_droll + y * j.dy_droll};
}

double without_attitude(double deviation, const AttitudeResponse& response, const Attitude& attitude) {
  return deviation + (1.0 + deviation) * correction(response, attitude);
}

double with_attitude(double corrected, const AttitudeResponse& response, const Attitude& attitude) {
  const double change = correction(response, attitude);
  return (corrected - change) / (1.0 + change);
}

}  // namespace astroid
