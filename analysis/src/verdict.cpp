#include "astroid/analysis/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "astroid/analysis/recovery.hpp"

namespace astroid {

namespace {

constexpr double kMillimagnitudes = 1000.0;

/// Decimals that show an error with one or two digits.
int decimals_for(double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return 1;
  const int digits = static_cast<int>(std::ceil(-std::log10(error)));
  return digits < 0 ? 0 : (digits > 6 ? 6 : digits);
}

std::string noise_line(std::span<const TargetMetrics> targets, const RunSetup& setup) {
  const NoiseSummary noise = noise_summary(targets);
  if (noise.stars == 0) return "no unsaturated target: nothing to compare";
  std::string line = fmt::format("{} unsaturated target{}, mag {:.1f}–{:.1f}: ", noise.stars,
                                 noise.stars == 1 ? "" : "s", noise.mag_min, noise.mag_max);
  if (noise.ratio.n == 0) {
    line += "noise not measured (too few exposures)";
  } else {
    const double half = noise.ratio.half_width();
    const int decimals = std::max(2, decimals_for(half));
    line += fmt::format("measured noise is {:.{}f} ± {:.{}f} of predicted (median{})", noise.ratio.value, decimals,
                        half, decimals, noise.within ? ", within bins" : "");
  }
  const RecoverySummary recovery = recovery_summary(targets, setup);
  if (recovery.stars == 0) return line + "; no uncontaminated star to judge the bias";
  const double error = recovery.bias_err * kMillimagnitudes;
  const int decimals = decimals_for(error);
  double bias = recovery.bias * kMillimagnitudes;
  if (std::abs(bias) < 0.5 * std::pow(10.0, -decimals)) bias = 0.0;  // no "-0.0"
  return line + fmt::format("; bias of uncontaminated stars {:+.{}f} ± {:.{}f} mmag", bias, decimals, error, decimals);
}

std::string duration_text(double hours) {
  constexpr double kSecondsPerHour = 3600.0;
  if (hours >= 1.0) return fmt::format("{:g} h", hours);
  return fmt::format("{:g} s", hours * kSecondsPerHour);
}

std::string requirement_line(std::span<const TargetMetrics> targets, const RunSetup& setup, double bin_hours,
                             const Requirement& requirement) {
  const std::string what = fmt::format("noise at mag {:g} in {} with {} camera{}", requirement.magnitude,
                                       duration_text(bin_hours), setup.cameras, setup.cameras == 1 ? "" : "s");
  const std::optional<NoiseAtMagnitude> noise = noise_at_magnitude(targets, requirement.magnitude);
  if (!noise) return what + ": not known, fewer than 5 unsaturated targets within 1 mag";
  std::string line = what + fmt::format(": {:.1f} ppm{}, requirement {:.0f} ppm: ", noise->ppm,
                                        noise->measured ? "" : " (predicted)", requirement.ppm);
  line += noise->ppm <= requirement.ppm ? "met" : "not met";
  const bool sure = noise->low > requirement.ppm || noise->high <= requirement.ppm;
  if (noise->measured && !sure)
    line += fmt::format(", but not surely (95 %: {:.1f}–{:.1f} ppm)", noise->low, noise->high);
  return line;
}

}  // namespace

std::vector<std::string> verdict(std::span<const TargetMetrics> targets, const RunSetup& setup, double bin_hours,
                                 const std::optional<Requirement>& requirement) {
  std::vector<std::string> lines{noise_line(targets, setup)};
  if (requirement) lines.push_back(requirement_line(targets, setup, bin_hours, *requirement));
  return lines;
}

}  // namespace astroid
