#include "astroid/analysis/noise_vs_magnitude.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/statistics/regression.hpp"
#include "magnitude_bins.hpp"

namespace astroid {

namespace {

// With fewer bins the scatter of their means says little of one star.
constexpr std::int64_t kBinsForMeans = 10;
constexpr std::int64_t kStarsForMedian = 5;

bool judges_noise(const TargetMetrics& target) {
  return is_clean(target) && std::isfinite(target.nsr_1h_ppm) && target.nsr_1h_ppm > 0.0;
}

template <class Pick>
double median_of(const std::vector<const TargetMetrics*>& stars, Pick pick) {
  std::vector<double> values;
  values.reserve(stars.size());
  for (const TargetMetrics* star : stars) values.push_back(pick(*star));
  return median_estimate(values).value;
}

NoiseByCause median_causes(const std::vector<const TargetMetrics*>& stars) {
  const auto cause = [&stars](double NoiseByCause::*part) {
    return median_of(stars, [part](const TargetMetrics& t) { return t.predicted.bin.*part; });
  };
  return {cause(&NoiseByCause::photon),  cause(&NoiseByCause::contaminants), cause(&NoiseByCause::background),
          cause(&NoiseByCause::readout), cause(&NoiseByCause::quantisation), cause(&NoiseByCause::background_estimate),
          cause(&NoiseByCause::jitter),  cause(&NoiseByCause::prnu_jitter),  cause(&NoiseByCause::smearing),
          cause(&NoiseByCause::bias),    cause(&NoiseByCause::drift)};
}

MedianEstimate median_ratio(const std::vector<const TargetMetrics*>& stars, bool within) {
  NoiseRatio ratio;
  std::vector<double> values;
  values.reserve(stars.size());
  for (const TargetMetrics* star : stars) values.push_back(ratio(*star, within));
  return median_estimate(values);
}

}  // namespace

double NoiseRatio::operator()(const TargetMetrics& target, bool within) {
  const NoiseEstimate& measured = within ? target.nsr_1h_within_measured : target.nsr_1h_measured;
  if (measured.dof < 1) return std::nan("");
  if (measured.dof != dof_) {
    dof_ = measured.dof;
    factor_ = c4(dof_ + 1) / deviation_interval(dof_).median;
  }
  const double predicted = within ? target.predicted.bin_within : target.predicted.bin_simulated;
  return measured.value * factor_ / predicted;
}

std::vector<NoiseBin> noise_vs_magnitude(std::span<const TargetMetrics> targets, double width) {
  std::vector<NoiseBin> bins;
  for (auto& [number, all] : by_magnitude(targets, width)) {
    std::vector<const TargetMetrics*> stars;
    std::copy_if(all.begin(), all.end(), std::back_inserter(stars),
                 [](const TargetMetrics* target) { return judges_noise(*target); });
    if (stars.empty()) continue;
    NoiseBin bin;
    bin.mag_low = static_cast<double>(number) * width;
    bin.mag_high = static_cast<double>(number + 1) * width;
    bin.stars = static_cast<std::int64_t>(stars.size());
    bin.mag_median = median_of(stars, [](const TargetMetrics& t) { return t.mag; });
    bin.predicted_ppm = median_of(stars, [](const TargetMetrics& t) { return t.nsr_1h_ppm; });
    bin.causes = median_causes(stars);
    bin.measured_ppm = median_of(stars, [](const TargetMetrics& t) { return t.nsr_1h_scaled.value; });
    bin.measured_within_ppm = median_of(stars, [](const TargetMetrics& t) { return t.nsr_1h_within_scaled.value; });
    bin.ratio = median_ratio(stars, false);
    bin.ratio_within = median_ratio(stars, true);
    bins.push_back(bin);
  }
  return bins;
}

NoiseSummary noise_summary(std::span<const TargetMetrics> targets) {
  NoiseSummary out;
  std::vector<const TargetMetrics*> stars;
  std::int64_t many_bins = 0;
  for (const TargetMetrics& target : targets) {
    if (!judges_noise(target)) continue;
    stars.push_back(&target);
    if (target.bins >= kBinsForMeans) ++many_bins;
    out.mag_min = std::fmin(out.mag_min, target.mag);
    out.mag_max = std::fmax(out.mag_max, target.mag);
  }
  out.stars = static_cast<std::int64_t>(stars.size());
  out.within = 2 * many_bins < out.stars;
  out.ratio = median_ratio(stars, out.within);
  return out;
}

std::optional<NoiseAtMagnitude> noise_at_magnitude(std::span<const TargetMetrics> targets, double magnitude) {
  constexpr double kReach = 1.0;  // mag: the noise is a straight line in (mag, log noise) over this much
  std::vector<const TargetMetrics*> stars;
  for (const TargetMetrics& target : targets) {
    if (judges_noise(target) && std::abs(target.mag - magnitude) <= kReach) stars.push_back(&target);
  }
  if (static_cast<std::int64_t>(stars.size()) < kStarsForMedian) return std::nullopt;

  std::vector<double> magnitudes;
  std::vector<double> logarithms;
  magnitudes.reserve(stars.size());
  logarithms.reserve(stars.size());
  for (const TargetMetrics* star : stars) {
    magnitudes.push_back(star->mag);
    logarithms.push_back(std::log(star->nsr_1h_ppm));
  }
  const double fitted = fit_line(magnitudes, logarithms).slope;
  const double slope = std::isfinite(fitted) ? fitted : 0.0;  // all of one magnitude

  const auto at_magnitude = [&](auto noise_of) {
    std::vector<double> logs;
    logs.reserve(stars.size());
    for (const TargetMetrics* star : stars) {
      logs.push_back(std::log(noise_of(*star)) - slope * (star->mag - magnitude));
    }
    return median_estimate(logs);
  };
  const NoiseSummary summary = noise_summary(targets);
  MedianEstimate level = at_magnitude([&summary](const TargetMetrics& star) {
    return summary.within ? star.nsr_1h_within_scaled.value : star.nsr_1h_scaled.value;
  });
  const bool measured = level.n >= kStarsForMedian;
  if (!measured) level = at_magnitude([](const TargetMetrics& star) { return star.nsr_1h_ppm; });
  return NoiseAtMagnitude{magnitude, std::exp(level.value), std::exp(level.low), std::exp(level.high), level.n,
                          measured};
}

Requirement plato_requirement(int cameras, double bin_hours) {
  constexpr double kNoise = 50.0;      // ppm in 1 h
  constexpr double kCameras = 24.0;    // that it is meant for
  constexpr double kMagnitude = 11.0;  // V
  return {"PLATO P1", kMagnitude, kNoise * std::sqrt(kCameras / cameras / bin_hours)};
}

Compliance compliance(std::span<const TargetMetrics> targets, const Requirement& requirement) {
  Compliance out;
  for (const TargetMetrics& target : targets) {
    if (!judges_noise(target) || target.mag > requirement.magnitude) continue;
    ++out.targets;
    if (target.nsr_1h_ppm <= requirement.ppm) ++out.predicted;
    if (target.nsr_1h_scaled.low <= requirement.ppm) ++out.measured;
  }
  return out;
}

}  // namespace astroid
