// The result of an assessment in two plain lines.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/noise_vs_magnitude.hpp"
#include "astroid/analysis/target_metrics.hpp"

namespace astroid {

/// "412 unsaturated targets, mag 6.1–13.9: measured noise is 1.003 ± 0.004 of predicted (median); bias of
/// uncontaminated stars +0.2 ± 0.3 mmag", and "noise at mag 11 in 1 h with 24 cameras: 49.4 ppm, requirement 50 ppm:
/// met".
///
/// Intervals are 95 % for the noise and one standard error for the bias. What could not be measured is said, not left
/// out.
/// @param bin_hours  duration of the bin.
std::vector<std::string> verdict(std::span<const TargetMetrics> targets, const RunSetup& setup, double bin_hours,
                                 const std::optional<Requirement>& requirement);

}  // namespace astroid
