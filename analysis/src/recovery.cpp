#include "astroid/analysis/recovery.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/photometric.hpp"
#include "magnitude_bins.hpp"

namespace astroid {

namespace {

double relative_difference(const TargetMetrics& target) {
  return target.flux_measured / target.flux_expected - 1.0;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? std::nan("") : std::sqrt(sum / static_cast<double>(values.size()));
}

RecoveryBin recovery_bin(const std::vector<const TargetMetrics*>& stars, const RunSetup& setup) {
  RecoveryBin bin;
  std::vector<double> delta, contamination, loss, residual_clean, residual, expected, pull, flux;
  for (const TargetMetrics* target : stars) {
    if (!std::isfinite(target->flux_measured)) continue;
    ++bin.stars;
    if ((target->flags & measurement_flag::kSaturated) != 0) ++bin.saturated;
    if (!(target->flux_measured > 0.0)) ++bin.not_positive;
    if (!is_clean(*target)) continue;
    ++bin.clean;
    delta.push_back(target->delta_mag);
    contamination.push_back(target->causes.contamination);
    loss.push_back(target->causes.aperture_loss);
    residual_clean.push_back(target->causes.residual);
    if (!is_uncontaminated(*target, setup)) continue;
    ++bin.uncontaminated;
    const double error = expected_flux_error(*target);
    residual.push_back(target->causes.residual);
    flux.push_back(relative_difference(*target));
    if (std::isfinite(error) && error > 0.0) {
      expected.push_back(kPogson * error);
      pull.push_back(relative_difference(*target) / error);
    }
  }
  bin.delta_median = median_estimate(delta).value;
  bin.contamination_median = median_estimate(contamination).value;
  bin.aperture_loss_median = median_estimate(loss).value;
  bin.residual_median = median_estimate(residual_clean).value;
  bin.residual = mean_estimate(residual);
  bin.flux_bias = mean_estimate(flux);
  bin.expected_scatter = rms(expected);
  bin.pull_width = rms(pull);
  return bin;
}

}  // namespace

double expected_flux_error(const TargetMetrics& target) {
  const double noise = target.flux_err / std::abs(target.flux_measured);
  const double fixed = target.prnu_magnitude / kPogson;
  return std::sqrt(noise * noise + fixed * fixed);
}

std::vector<RecoveryBin> magnitude_recovery(std::span<const TargetMetrics> targets, const RunSetup& setup,
                                            double width) {
  std::vector<RecoveryBin> bins;
  for (const auto& [number, stars] : by_magnitude(targets, width)) {
    RecoveryBin bin = recovery_bin(stars, setup);
    if (bin.stars == 0) continue;
    bin.mag_low = static_cast<double>(number) * width;
    bin.mag_high = static_cast<double>(number + 1) * width;
    bins.push_back(bin);
  }
  return bins;
}

RecoverySummary recovery_summary(std::span<const TargetMetrics> targets, const RunSetup& setup) {
  RecoverySummary out;
  double weight = 0.0;
  double sum = 0.0;
  double squares = 0.0;  // of difference / error
  for (const TargetMetrics& target : targets) {
    if (!is_uncontaminated(target, setup)) continue;
    const double error = expected_flux_error(target);
    if (!(error > 0.0) || !std::isfinite(error)) continue;
    const double difference = relative_difference(target);
    ++out.stars;
    weight += 1.0 / (error * error);
    sum += difference / (error * error);
    squares += difference * difference / (error * error);
  }
  if (out.stars == 0) return out;
  const double n = static_cast<double>(out.stars);
  const double mean = sum / weight;
  out.bias = -kPogson * mean;
  out.pull_width = std::sqrt(squares / n);
  const double chi2 = std::max(0.0, squares - mean * mean * weight);
  const double raise = out.stars > 1 ? std::max(1.0, chi2 / (n - 1.0)) : 1.0;
  out.bias_err = kPogson * std::sqrt(raise / weight);
  return out;
}

FaintBias faint_star_bias(std::span<const TargetMetrics> targets, const RunSetup& setup, double magnitudes) {
  FaintBias out;
  double faintest = -HUGE_VAL;
  for (const TargetMetrics& target : targets) {
    if (is_uncontaminated(target, setup)) faintest = std::max(faintest, target.mag);
  }
  if (!std::isfinite(faintest)) return out;
  out.mag_from = faintest - magnitudes;
  std::vector<double> differences;
  for (const TargetMetrics& target : targets) {
    if (is_uncontaminated(target, setup) && target.mag >= out.mag_from) {
      differences.push_back(relative_difference(target));
    }
  }
  out.relative = mean_estimate(differences);
  return out;
}

}  // namespace astroid
