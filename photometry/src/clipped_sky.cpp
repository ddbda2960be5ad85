#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/math.hpp"
#include "astroid/photometry/background.hpp"
#include "mesh/clipping.hpp"

namespace astroid {

namespace {

// SExtractor trusts mean and median to tell the mode while they differ by less than this many sigma.
constexpr double kModeLimit = 0.3;
constexpr double kModeMedian = 2.5;
constexpr double kModeMean = 1.5;

struct Moments {
  double mean = 0.0;
  double rms = 0.0;
};

Moments moments(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double v : values) sum += v;
  const double mean = sum / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0};
}

}  // namespace

// The s of s = f(clip s), with f(t)² = 1 - 2 t φ(t) / (2 Φ(t) - 1) the variance of a normal distribution cut at ± t.
// Below √3 sigma clipping would never end, so the last value before is taken.
double detail::clipped_share(double clip) {
  if (!std::isfinite(clip)) return 1.0;
  constexpr double kLeastClip = 1.8;
  constexpr int kIterations = 60;
  const double k = std::max(clip, kLeastClip);
  double share = 1.0;
  for (int i = 0; i < kIterations; ++i) {
    const double t = k * share;
    const double density = det::exp(-0.5 * t * t) / std::sqrt(2.0 * kPi);
    share = std::sqrt(1.0 - 2.0 * t * density / det::erf(t / std::sqrt(2.0)));
  }
  return share;
}

double detail::mode_from(double median, double mean, double rms) {
  return std::abs(mean - median) < kModeLimit * rms ? kModeMedian * median - kModeMean * mean : median;
}

double smoothed_median(std::span<const double> sorted) {
  const std::size_t n = sorted.size();
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  const double middle = sorted[n / 2];
  const auto equal = std::equal_range(sorted.begin(), sorted.end(), middle);
  const auto below = static_cast<double>(equal.first - sorted.begin());
  const auto count = static_cast<double>(equal.second - equal.first);
  const double lower = n % 2 == 0 ? sorted[n / 2 - 1] : middle;
  if (count < 2.0 || equal.first == sorted.begin() || equal.second == sorted.end()) return 0.5 * (lower + middle);
  const double low_edge = 0.5 * (middle + *(equal.first - 1));
  const double high_edge = 0.5 * (middle + *equal.second);
  const double share = std::clamp((0.5 * static_cast<double>(n) - below) / count, 0.0, 1.0);
  return low_edge + (high_edge - low_edge) * share;
}

SkyEstimate clipped_sky(std::vector<double>& values, double clip, bool mode) {
  std::sort(values.begin(), values.end());
  std::span<const double> kept(values);
  SkyEstimate sky;
  sky.level = smoothed_median(kept);
  sky.mode = sky.level;
  if (kept.empty()) return sky;
  Moments m = moments(kept);
  for (int i = 0; i < detail::kMostClippings && m.rms > 0.0; ++i) {
    // Against all values, not only the ones kept so far: one that was clipped too early comes back.
    const auto first = std::lower_bound(values.begin(), values.end(), sky.level - clip * m.rms);
    const auto last = std::upper_bound(values.begin(), values.end(), sky.level + clip * m.rms);
    const std::span<const double> next(values.data() + (first - values.begin()),
                                       static_cast<std::size_t>(last - first));
    if (next.empty() || (next.data() == kept.data() && next.size() == kept.size())) break;
    kept = next;
    sky.level = smoothed_median(kept);
    m = moments(kept);
  }
  sky.rms = m.rms / detail::clipped_share(clip);
  sky.pixels = kept.size();
  sky.mode = detail::mode_from(sky.level, m.mean, m.rms);
  if (mode) sky.level = sky.mode;
  return sky;
}

}  // namespace astroid
