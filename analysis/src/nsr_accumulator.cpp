#include "astroid/analysis/nsr_accumulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/error.hpp"

namespace astroid {

double SeriesStatistics::total(const std::array<double, kLanes>& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

SeriesStatistics::SeriesStatistics(std::size_t stars, std::int64_t exposures_per_bin, bool keep_bin_means)
    : per_bin_(exposures_per_bin), keep_bin_means_(keep_bin_means), stars_(stars) {
  ASTROID_CHECK_LE(2, exposures_per_bin);
  c4_.assign(static_cast<std::size_t>(per_bin_) + 1, 0.0);
  for (std::int64_t n = 2; n <= per_bin_; ++n) c4_[static_cast<std::size_t>(n)] = c4(n);
}

void SeriesStatistics::close(Star& star) const {
  const std::int64_t n = star.open_n;
  star.open_n = 0;
  if (n == 0) return;
  const double count = static_cast<double>(n);
  const double sum = total(star.sum);
  const double mean = star.shift + sum / count;
  const double m2 = std::max(0.0, total(star.sum_squares) - sum * sum / count);

  const double all = static_cast<double>(star.n + n);
  const double delta = mean - star.mean;
  star.m2 += m2 + delta * delta * (static_cast<double>(star.n) * count / all);
  star.mean += delta * (count / all);
  star.n += n;

  // A bin with fewer than half its exposures is not a measurement of the bin.
  if (2 * n < per_bin_ || n < 2) return;
  ++star.bins;
  if (keep_bin_means_) {
    star.bin_means.resize(static_cast<std::size_t>(star.open_bin), std::numeric_limits<float>::quiet_NaN());
    star.bin_means.push_back(static_cast<float>(mean));
  }
  star.within_dof += n - 1;
  star.deviation_sum += std::sqrt(m2 / static_cast<double>(n - 1)) / c4_[static_cast<std::size_t>(n)];
  const double weight = star.weight + count;
  const double step = mean - star.bin_mean;
  star.bin_m2 += step * step * (star.weight * count / weight);
  star.bin_mean += step * (count / weight);
  star.weight = weight;
}

void SeriesStatistics::add(std::size_t star_index, std::int64_t first, std::span<const float> deviation) {
  Star& star = stars_[star_index];
  ASTROID_CHECK_LE(star.next, first);
  star.next = first + static_cast<std::int64_t>(deviation.size());
  std::int64_t exposure = first;
  while (!deviation.empty()) {
    const std::int64_t bin = exposure / per_bin_;
    if (bin != star.open_bin) {
      close(star);
      star.open_bin = bin;
      star.sum.fill(0.0);
      star.sum_squares.fill(0.0);
    }
    const auto left = static_cast<std::size_t>((bin + 1) * per_bin_ - exposure);
    const std::size_t count = std::min(deviation.size(), left);
    add_to_bin(star, static_cast<std::size_t>(exposure - bin * per_bin_), deviation.first(count));
    deviation = deviation.subspan(count);
    exposure += static_cast<std::int64_t>(count);
  }
}

void SeriesStatistics::add_to_bin(Star& star, std::size_t place, std::span<const float> deviation) {
  const auto missing = std::count_if(deviation.begin(), deviation.end(), [](float d) { return std::isnan(d); });
  star.missing += missing;
  const std::int64_t measured = static_cast<std::int64_t>(deviation.size()) - missing;
  if (measured == 0) return;
  if (star.open_n == 0)
    star.shift = *std::find_if(deviation.begin(), deviation.end(), [](float d) { return !std::isnan(d); });
  star.open_n += measured;
  // In variables of their own, which nothing else can point at.
  const double shift = star.shift;
  std::array<double, kLanes> sum = star.sum;
  std::array<double, kLanes> squares = star.sum_squares;
  const auto add_one = [&](std::size_t i) {
    if (std::isnan(deviation[i])) return;
    const std::size_t lane = (place + i) % kLanes;
    const double e = static_cast<double>(deviation[i]) - shift;
    sum[lane] += e;
    squares[lane] += e * e;
  };
  std::size_t i = 0;
  if (missing == 0) {
    for (; i < deviation.size() && (place + i) % kLanes != 0; ++i) add_one(i);
    for (; i + kLanes <= deviation.size(); i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double e = static_cast<double>(deviation[i + lane]) - shift;
        sum[lane] += e;
        squares[lane] += e * e;
      }
    }
  }
  for (; i < deviation.size(); ++i) add_one(i);
  star.sum = sum;
  star.sum_squares = squares;
}

SeriesSummary SeriesStatistics::summary(std::size_t star_index) const {
  Star star = stars_[star_index];
  close(star);
  SeriesSummary out;
  out.exposures = star.n;
  out.missing = star.missing;
  out.bins = star.bins;
  out.mean = star.n > 0 ? star.mean : std::nan("");
  // Relative to a mean flux that is not positive, noise has no meaning.
  const double mean_flux = 1.0 + star.mean;
  const double relative = mean_flux > 0.0 ? 1.0 / mean_flux : std::nan("");
  if (star.n >= 2) {
    out.exposure = noise_estimate(std::sqrt(star.m2 / static_cast<double>(star.n - 1)), star.n - 1).scaled(relative);
  }
  const double per_bin = static_cast<double>(per_bin_);
  if (star.bins >= 1) {
    const double sigma = star.deviation_sum / static_cast<double>(star.bins);
    NoiseEstimate within = noise_estimate(sigma, star.within_dof);
    within.value = sigma;  // each bin has been corrected by its own c4
    out.bin_within = within.scaled(relative / std::sqrt(per_bin));
  }
  if (star.bins >= 2) {
    // The mean square between bins, sum m (x - mean)^2 / (bins - 1), estimates the variance of one exposure.
    const double sigma = std::sqrt(star.bin_m2 / static_cast<double>(star.bins - 1));
    out.bin_means = noise_estimate(sigma, star.bins - 1).scaled(relative / std::sqrt(per_bin));
  }
  return out;
}

std::vector<float> SeriesStatistics::bin_means(std::size_t star_index, std::size_t bins) const {
  if (!keep_bin_means_) return {};
  Star star = stars_[star_index];
  close(star);
  star.bin_means.resize(bins, std::numeric_limits<float>::quiet_NaN());
  return std::move(star.bin_means);
}

std::vector<SeriesSummary> SeriesStatistics::summaries() const {
  std::vector<SeriesSummary> out;
  out.reserve(stars_.size());
  for (std::size_t star = 0; star < stars_.size(); ++star) out.push_back(summary(star));
  return out;
}

std::vector<float> all_bin_means(const SeriesStatistics& statistics, std::int64_t exposures) {
  const std::int64_t per_bin = statistics.exposures_per_bin();
  const auto bins = static_cast<std::size_t>((exposures + per_bin - 1) / per_bin);
  std::vector<float> all;
  for (std::size_t star = 0; star < statistics.stars(); ++star) {
    const std::vector<float> means = statistics.bin_means(star, bins);
    all.insert(all.end(), means.begin(), means.end());
  }
  return all;
}

}  // namespace astroid
