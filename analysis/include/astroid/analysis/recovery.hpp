// Magnitude in against magnitude out. Fluxes are averaged, never magnitudes.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "astroid/analysis/confidence.hpp"
#include "astroid/analysis/target_metrics.hpp"

namespace astroid {

inline constexpr double kMagnitudeBin = 0.5;  ///< default width of a bin, mag; edges are its multiples

/// A row of analysis/magnitude_recovery.csv. Medians are of clean stars (is_clean), the rest of uncontaminated ones.
struct RecoveryBin {
  double mag_low = 0.0, mag_high = 0.0;
  std::int64_t stars = 0;         ///< measured
  std::int64_t not_positive = 0;  ///< measured flux <= 0: without a magnitude
  std::int64_t saturated = 0;
  std::int64_t clean = 0;
  std::int64_t uncontaminated = 0;
  double delta_median = std::numeric_limits<double>::quiet_NaN();  ///< measured - true, mag
  double contamination_median = std::numeric_limits<double>::quiet_NaN();
  double aperture_loss_median = std::numeric_limits<double>::quiet_NaN();
  double residual_median = std::numeric_limits<double>::quiet_NaN();
  MeanEstimate residual;  ///< bias, its error and the scatter from star to star, mag
  double expected_scatter = std::numeric_limits<double>::quiet_NaN();  ///< rms of the predicted errors, mag
  double pull_width = std::numeric_limits<double>::quiet_NaN();        ///< rms of residual / predicted error
  MeanEstimate flux_bias;  ///< of flux_measured / flux_expected - 1: free of the logarithm's bias
};

std::vector<RecoveryBin> magnitude_recovery(std::span<const TargetMetrics> targets, const RunSetup& setup,
                                            double width = kMagnitudeBin);

/// Bias of all uncontaminated stars together, weighted by their predicted errors; from fluxes, told in magnitudes.
struct RecoverySummary {
  std::int64_t stars = 0;
  double bias = std::numeric_limits<double>::quiet_NaN();        ///< mag
  double bias_err = std::numeric_limits<double>::quiet_NaN();    ///< mag; raised by sqrt(chi2/dof) when that is above 1
  double pull_width = std::numeric_limits<double>::quiet_NaN();  ///< rms of (measured - expected) / predicted error
};
RecoverySummary recovery_summary(std::span<const TargetMetrics> targets, const RunSetup& setup);

/// Are the faintest stars measured without bias? Mean of flux_measured / flux_expected - 1 of the uncontaminated stars
/// of the faintest `magnitudes`.
struct FaintBias {
  double mag_from = std::numeric_limits<double>::quiet_NaN();
  MeanEstimate relative;
  [[nodiscard]] double z() const { return relative.value / relative.error; }
};
FaintBias faint_star_bias(std::span<const TargetMetrics> targets, const RunSetup& setup, double magnitudes = 1.0);

/// The error that is expected of a target's measured flux, relative to it: noise of the mean and fixed unequal pixels.
double expected_flux_error(const TargetMetrics& target);

}  // namespace astroid
