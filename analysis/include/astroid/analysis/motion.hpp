// How much a star moves on the detector, and what of that is left in a mean over time.
#pragma once

#include <cstdint>

#include "astroid/core/mission.hpp"

namespace astroid {

/// Covariance of a displacement on the detector, px².
struct MotionCovariance {
  double sxx = 0.0;
  double sxy = 0.0;
  double syy = 0.0;
  /// Variance of gx dx + gy dy.
  [[nodiscard]] double along(double gx, double gy) const { return gx * gx * sxx + 2.0 * gx * gy * sxy + gy * gy * syy; }
};

/// The motion of one star: of its mean position in an exposure, and of the mean of that over a bin.
struct StarMotion {
  MotionCovariance exposure;
  MotionCovariance bin;
};

/// Times of a series of exposures, s.
struct Cadence {
  double exposure = 0.0;     ///< duration of one exposure
  double cycle = 0.0;        ///< from start to start
  std::int64_t per_bin = 1;  ///< exposures in a bin
};

/// The part of the variance of an Ornstein-Uhlenbeck process that is left in its mean over one exposure, and in the
/// mean of all exposures of a bin (each of them a mean over the exposure).
/// @param timescale  s, > 0.  @source F25, F29: exact for any cadence with exposure <= cycle.
struct RetainedVariance {
  double exposure = 1.0;
  double bin = 1.0;
};
RetainedVariance red_noise_retained(double timescale, const Cadence& cadence);

/// Motion of a star by the mission's jitter model, at a place `offset_x`, `offset_y` px from the optical axis: yaw
/// moves along x, pitch along y, roll around the axis. Zero for no jitter; a jitter file must be evaluated by its
/// reader.
StarMotion star_motion(const Mission& mission, double offset_x, double offset_y);

}  // namespace astroid
