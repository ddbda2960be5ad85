// Jitter correction: the attitude of each exposure as the ground knows it, taken out of every flux.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/random.hpp"
#include "astroid/photometry/attitude_response.hpp"
#include "astroid/photometry/attitude_sensor.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// What the ground believes of the attitude of exposures of one group of cameras, and how targets' fluxes follow it.
///
/// Either the spacecraft tells it, with an error of Photometry/Knowledge/Attitude that all cameras share and that is
/// new in every exposure, or each camera measures it by its own bright targets.
/// @source F130, F131, F155
class AttitudeCorrection {
 public:
  /// @param estimators  of the targets.
  /// @param origin      attitude for which the model has the places of the stars; others are relative to it.
  /// @throws InputError when there is no star to measure the attitude by.
  AttitudeCorrection(const Scene& scene, const GroundModel& model, std::span<const StarEstimator> estimators,
                     const Attitude& origin);

  [[nodiscard]] bool is_measured() const { return sensor_.has_value(); }
  /// @param truth       mean attitude of the exposure.
  /// @param calibrated  its frame, as fluxes are measured in it.
  /// @returns           relative to the origin.
  [[nodiscard]] Attitude attitude(std::int64_t exposure, const Attitude& truth, const Frame& calibrated) const;

  /// Of each target.
  [[nodiscard]] std::span<const AttitudeResponse> responses() const { return responses_; }
  /// Error of attitude(): of each camera its own where it is measured, else the same in all of them.
  [[nodiscard]] const AttitudeCovariance& error() const { return error_; }
  /// For people.
  [[nodiscard]] std::string description() const;

 private:
  std::vector<AttitudeResponse> responses_;
  std::optional<AttitudeSensor> sensor_;
  AttitudeCovariance error_;
  RandomStream stream_;
  double known_rms_;  // arcsec
  Attitude origin_;
  std::int64_t first_;  // exposure of the run, counted from the start of the mission
};

/// A correction that holds from an exposure on, as the estimators do that it belongs to.
struct CorrectionStretch {
  std::int64_t first = 0;
  std::shared_ptr<const AttitudeCorrection> correction;
};
/// @param stretches  ascending, the first from exposure 0 on.
const AttitudeCorrection& correction_at(std::span<const CorrectionStretch> stretches, std::int64_t exposure);

}  // namespace astroid
