// Measured noise beside predicted noise, by magnitude.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/confidence.hpp"
#include "astroid/analysis/recovery.hpp"
#include "astroid/analysis/target_metrics.hpp"

namespace astroid {

/// A row of analysis/noise_vs_magnitude.csv: medians over the clean stars of a bin, ppm, N cameras.
struct NoiseBin {
  double mag_low = 0.0, mag_high = 0.0, mag_median = 0.0;
  std::int64_t stars = 0;
  double predicted_ppm = 0.0;
  NoiseByCause causes;  ///< each the median over the stars: their squares need not add up exactly
  double measured_ppm = std::numeric_limits<double>::quiet_NaN();         ///< by bin means, scaled to N cameras
  double measured_within_ppm = std::numeric_limits<double>::quiet_NaN();  ///< within bins, scaled to N cameras
  MedianEstimate ratio;         ///< measured / predicted by bin means, n cameras
  MedianEstimate ratio_within;  ///< measured / predicted within bins, n cameras
};
std::vector<NoiseBin> noise_vs_magnitude(std::span<const TargetMetrics> targets, double width = kMagnitudeBin);

/// Measured / predicted noise of one target by bin means, or within bins (`within`), with the n simulated cameras.
/// Freed of the bias that the median of a skewed distribution has, so that a median over stars is 1 when the prediction
/// is right.
class NoiseRatio {
 public:
  [[nodiscard]] double operator()(const TargetMetrics& target, bool within);

 private:
  std::int64_t dof_ = -1;  // of the factor below: stars of a run share it
  double factor_ = 1.0;
};

/// Measured / predicted noise of all clean stars together.
struct NoiseSummary {
  std::int64_t stars = 0;
  double mag_min = std::numeric_limits<double>::quiet_NaN();
  double mag_max = std::numeric_limits<double>::quiet_NaN();
  MedianEstimate ratio;
  bool within = false;  ///< from within bins, because there are too few bin means
};
NoiseSummary noise_summary(std::span<const TargetMetrics> targets);

/// The noise that a typical clean star of a magnitude has in one bin with N cameras, ppm.
///
/// The stars within a magnitude of it say by the median how far the noise lies off the straight line in (mag, log
/// noise) that fits the predictions. Measured where there are measurements, else predicted; nothing with fewer than 5
/// stars.
struct NoiseAtMagnitude {
  double magnitude = 0.0;
  double ppm = 0.0, low = 0.0, high = 0.0;  ///< low, high: 95 %
  std::int64_t stars = 0;
  bool measured = false;
};
std::optional<NoiseAtMagnitude> noise_at_magnitude(std::span<const TargetMetrics> targets, double magnitude);

/// A requirement: noise in one bin with all cameras for stars up to a magnitude.
struct Requirement {
  std::string name;
  double magnitude = 0.0;  ///< holds for stars this bright or brighter
  double ppm = 0.0;
};
/// PLATO's: 50 ppm in 1 h at V = 11 with 24 cameras, as 50 sqrt(24 / cameras), and in other bins as random noise goes,
/// with 1 / sqrt(bin_hours). @source GutierrezCanales2026
Requirement plato_requirement(int cameras, double bin_hours = 1.0);

/// The fraction of clean targets within the requirement's magnitude whose noise (scaled to N cameras) complies.
struct Compliance {
  std::int64_t targets = 0;
  std::int64_t predicted = 0;
  std::int64_t measured = 0;  ///< by the 95 % lower end: a star fails when its noise is above with 97.5 % confidence
};
Compliance compliance(std::span<const TargetMetrics> targets, const Requirement& requirement);

}  // namespace astroid
