// How a flux follows the attitude, and what is left of it without.
#pragma once

#include "astroid/core/attitude.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// Relative change of a target's flux with the attitude, per arcsec, to first order.
struct AttitudeResponse {
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
};
[[nodiscard]] AttitudeResponse attitude_response(const StarEstimator& estimator, const AttitudeJacobian& motion);

/// Takes the attitude out of a flux: (1 + deviation) exp(-response · attitude) - 1, the exponential to second order.
/// @param deviation  of the flux from its reference, relative; NaN stays NaN.
/// @source F131
[[nodiscard]] double without_attitude(double deviation, const AttitudeResponse& response, const Attitude& attitude);

/// The inverse: the flux as it was measured.
[[nodiscard]] double with_attitude(double corrected, const AttitudeResponse& response, const Attitude& attitude);

}  // namespace astroid
