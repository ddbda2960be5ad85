#include "astroid/core/statistics/robust.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/core/statistics/sums.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kDeviationPerMad = 1.4826022185056018605;  // 1 / Phi^-1(3/4)
constexpr double kTrim = 0.01;                              // at either end
constexpr double kTrimmedFactor = 0.9345935;                // deviation of Gaussian values after that trim

// The numbers in rising order.
std::vector<double> sorted_numbers(std::span<const double> values) {
  std::vector<double> numbers;
  numbers.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(numbers), [](double v) { return !std::isnan(v); });
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

double middle_of(std::span<const double> sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

RunningMoments moments_of(std::span<const double> values) {
  RunningMoments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

double trimmed_deviation(std::span<const double> sorted) {
  const auto cut = static_cast<std::size_t>(kTrim * static_cast<double>(sorted.size()));
  const RunningMoments kept = moments_of(sorted.subspan(cut, sorted.size() - 2 * cut));
  if (kept.count() < 2) return 0.0;
  return cut == 0 ? kept.standard_deviation() : kept.standard_deviation() / kTrimmedFactor;
}

}  // namespace

RobustSpread robust_spread(std::span<const double> values) {
  const std::vector<double> sorted = sorted_numbers(values);
  RobustSpread spread;
  spread.used = sorted.size();
  spread.ignored = values.size() - sorted.size();
  if (sorted.empty()) return spread;
  spread.centre = middle_of(sorted);
  std::vector<double> distances(sorted.size());
  std::transform(sorted.begin(), sorted.end(), distances.begin(),
                 [&](double v) { return v == spread.centre ? 0.0 : std::abs(v - spread.centre); });
  spread.value = kDeviationPerMad * median_in_place(distances).value;
  if (spread.value == 0.0) {
    spread.fell_back = true;
    spread.value = trimmed_deviation(sorted);
  }
  return spread;
}

ClippedSample sigma_clip(std::span<const double> values, const ClipRule& rule) {
  // Clipping keeps a contiguous part of the sorted values, so nothing is ever copied again.
  const std::vector<double> sorted = sorted_numbers(values);
  ClippedSample result;
  result.ignored = values.size() - sorted.size();
  if (sorted.empty()) return result;
  std::span<const double> kept = sorted;
  RunningMoments moments = moments_of(kept);
  while (result.passes < rule.passes && moments.count() > 1) {
    ++result.passes;
    const double deviation = moments.standard_deviation();
    if (!(deviation > 0.0)) break;
    const double centre = rule.about_median ? middle_of(kept) : moments.mean();
    const auto first = std::lower_bound(kept.begin(), kept.end(), centre - rule.low * deviation);
    const auto last = std::upper_bound(first, kept.end(), centre + rule.high * deviation);
    const auto size = static_cast<std::size_t>(last - first);
    if (size == kept.size() || size == 0) break;
    kept = kept.subspan(static_cast<std::size_t>(first - kept.begin()), size);
    moments = moments_of(kept);
  }
  result.kept = kept.size();
  result.clipped = sorted.size() - kept.size();
  result.mean = moments.mean();
  result.median = middle_of(kept);
  result.deviation = moments.count() > 1 ? moments.standard_deviation() : 0.0;
  result.lowest = kept.front();
  result.highest = kept.back();
  return result;
}

double clipped_deviation_factor(double k) {
  const double density = det::exp(-0.5 * k * k) / std::sqrt(2.0 * kPi);
  const double inside = det::erf(k / std::sqrt(2.0));
  return std::sqrt(1.0 - 2.0 * k * density / inside);
}

double background_mode(const ClippedSample& sample) {
  constexpr double kCrowded = 0.3;  // deviations between mean and median
  constexpr double kMedianWeight = 2.5;
  constexpr double kMeanWeight = 1.5;
  if (std::abs(sample.mean - sample.median) > kCrowded * sample.deviation) return sample.median;
  return kMedianWeight * sample.median - kMeanWeight * sample.mean;
}

double half_sample_mode(std::span<const double> values) {
  const std::vector<double> sorted = sorted_numbers(values);
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::span<const double> part = sorted;
  while (part.size() > 3) {
    const std::size_t half = (part.size() + 1) / 2;
    std::size_t best = 0;
    for (std::size_t i = 1; i + half <= part.size(); ++i) {
      if (part[i + half - 1] - part[i] < part[best + half - 1] - part[best]) best = i;
    }
    part = part.subspan(best, half);
  }
  if (part.size() == 3) {
    const double lower = part[1] - part[0];
    const double upper = part[2] - part[1];
    if (lower == upper) return part[1];
    part = lower < upper ? part.first(2) : part.last(2);
  }
  return 0.5 * (part.front() + part.back());
}

}  // namespace astroid
