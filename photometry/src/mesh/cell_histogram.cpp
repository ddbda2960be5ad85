#include "mesh/cell_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/clipping.hpp"

namespace astroid::detail {

namespace {

constexpr double kBinsPerSigma = 50.0;  // of the first guess of the scatter: bins reach to 10 of it on either side

struct Guess {
  double level = 0.0;
  double sigma = 0.0;
};

// Median, and its distance from the 16th percentile, which stars hardly reach, of about 127 of the values.
Guess guess_of(std::span<const float> values) {
  constexpr std::size_t kSample = 127;
  std::array<float, kSample> sample{};
  for (std::size_t i = 0; i < kSample; ++i) sample[i] = values[(2 * i + 1) * values.size() / (2 * kSample)];
  std::sort(sample.begin(), sample.end());
  constexpr std::size_t kLower = 20;  // of 127: the 16th percentile
  const auto median = static_cast<double>(sample[kSample / 2]);
  return {median, median - static_cast<double>(sample[kLower])};
}

}  // namespace

bool CellHistogram::fill(std::span<const float> values, double quantum) {
  if (values.size() < kFewestValues) return false;
  const Guess guess = guess_of(values);
  if (!(guess.sigma > 0.0)) return false;
  width_ = guess.sigma / kBinsPerSigma;
  origin_ = guess.level - 0.5 * static_cast<double>(kBins) * width_;
  constexpr std::size_t kTables = 4;  // so that equal neighbours do not wait for each other
  std::array<std::array<std::uint32_t, kBins>, kTables> tables{};
  const auto scale = static_cast<float>(1.0 / width_);
  const auto spread = static_cast<float>(quantum / width_);
  // Positions relative to the guess keep the digits of a float.
  const auto level = static_cast<float>(guess.level);
  const auto middle = static_cast<float>(0.5 * kBins + (static_cast<double>(level) - guess.level) / width_);
  constexpr float kLast = kBins - 1;
  // Multiples of the golden section fill [0, 1) evenly, however many there are.
  constexpr std::uint32_t kGolden = 2654435769U;
  constexpr float kToUnit = 1.0F / 16777216.0F;
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    float t = (values[i] - level) * scale + middle;
    word += kGolden;
    t += spread * (static_cast<float>(word >> 8U) * kToUnit - 0.5F);
    t = t > 0.0F ? t : 0.0F;
    t = t < kLast ? t : kLast;
    ++tables[i % kTables][static_cast<std::size_t>(static_cast<int>(t))];
  }
  for (std::size_t b = 0; b < kBins; ++b) {
    count_[b] = tables[0][b] + tables[1][b] + tables[2][b] + tables[3][b];
    const auto n = static_cast<std::int64_t>(count_[b]);
    const auto k = static_cast<std::int64_t>(b);
    before_[b + 1] = before_[b] + n;
    first_[b + 1] = first_[b] + n * k;
    second_[b + 1] = second_[b] + n * k * k;
  }
  return true;
}

// Where the median of bins first … last-1 lies, in bins from the origin.
double CellHistogram::quantile_position(std::size_t first, std::size_t last) const {
  const double half = 0.5 * static_cast<double>(before_[first] + before_[last]);
  const auto after = std::upper_bound(before_.begin() + static_cast<std::ptrdiff_t>(first),
                                      before_.begin() + static_cast<std::ptrdiff_t>(last), half,
                                      [](double value, std::int64_t sum) { return value < static_cast<double>(sum); });
  const auto bin = static_cast<std::size_t>(after - before_.begin()) - 1;
  const auto n = static_cast<double>(count_[bin]);
  if (!(n > 0.0)) return static_cast<double>(bin) + 0.5;
  return static_cast<double>(bin) + (half - static_cast<double>(before_[bin])) / n;
}

bool CellHistogram::clipped(double clip, bool mode, SkyEstimate& sky) const {
  std::size_t first = 0;
  std::size_t last = kBins;
  double median = 0.0;
  double mean = 0.0;
  double rms = 0.0;
  for (int i = 0; i < kMostClippings; ++i) {
    const auto n = static_cast<double>(before_[last] - before_[first]);
    if (n < 2.0) return false;
    median = quantile_position(first, last);
    const double m = static_cast<double>(first_[last] - first_[first]) / n;
    const double square = static_cast<double>(second_[last] - second_[first]) / n;
    // Sheppard: values within a bin scatter by a twelfth of its square; the evenly spread counts hold it already.
    rms = std::sqrt(std::max(0.0, square - m * m) * n / (n - 1.0));
    mean = m + 0.5;
    const double low = median - clip * rms;
    const double high = median + clip * rms;
    const auto next_first = static_cast<std::size_t>(std::clamp(std::floor(low + 0.5), 0.0, median));
    const auto next_last =
        static_cast<std::size_t>(std::clamp(std::floor(high + 0.5), median + 1.0, static_cast<double>(kBins)));
    if (next_first == first && next_last == last) break;
    first = next_first;
    last = next_last;
  }
  // The end bins hold what lies beyond them as well.
  if (first == 0 || last == kBins) return false;
  sky.level = origin_ + width_ * median;
  sky.rms = width_ * rms / clipped_share(clip);
  sky.pixels = static_cast<std::size_t>(before_[last] - before_[first]);
  sky.mode = mode_from(sky.level, origin_ + width_ * mean, width_ * rms);
  if (mode) sky.level = sky.mode;
  return true;
}

void CellHistogram::add_scaled(double level, double rms, double reach, double step, std::span<double> bins) const {
  const double width = width_ / (rms * step);
  const double start = (origin_ - level) / (rms * step) + reach / step;
  const auto end = static_cast<double>(bins.size());
  for (std::size_t b = 1; b + 1 < kBins; ++b) {
    const double low = start + width * static_cast<double>(b);
    const double high = low + width;
    if (count_[b] == 0 || low < 0.0 || high >= end) continue;
    const auto i = static_cast<std::size_t>(low);
    const auto j = static_cast<std::size_t>(high);
    const auto n = static_cast<double>(count_[b]);
    if (i == j) {
      bins[i] += n;
      continue;
    }
    // A bin of ours is narrower than one of theirs, unless the scatter is far larger than was guessed.
    const double density = n / width;
    bins[i] += density * (static_cast<double>(i + 1) - low);
    for (std::size_t k = i + 1; k < j; ++k) bins[k] += density;
    bins[j] += density * (high - static_cast<double>(j));
  }
}

void add_scaled(std::span<const double> values, double level, double rms, double reach, double step,
                std::span<double> bins) {
  if (!(rms > 0.0)) return;
  for (const double value : values) {
    const double t = (value - level) / (rms * step) + reach / step;
    if (t >= 0.0 && t < static_cast<double>(bins.size())) bins[static_cast<std::size_t>(t)] += 1.0;
  }
}

double quantum_of(std::span<const float> values) {
  constexpr std::size_t kMost = 4096;
  std::vector<float> sorted(values.begin(),
                            values.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, values.size())));
  if (sorted.size() < 2) return 0.0;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  const double scatter = static_cast<double>(sorted[n / 2]) - static_cast<double>(sorted[n / 6]);
  double step = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    const double gap = static_cast<double>(sorted[i]) - static_cast<double>(sorted[i - 1]);
    if (gap > 0.0 && (step == 0.0 || gap < step)) step = gap;
  }
  // Values that were not digitised lie closer than that somewhere among thousands.
  constexpr double kLeast = 0.01;
  return step > kLeast * scatter ? step : 0.0;
}

}  // namespace astroid::detail
