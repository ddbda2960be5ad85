#include "astroid/core/statistics/allan.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/statistics/sums.hpp"

namespace astroid {

namespace {

// Calls f with every gap-free stretch of the series.
template <class F>
void for_each_stretch(std::span<const double> series, F&& f) {
  std::size_t first = 0;
  while (first < series.size()) {
    std::size_t last = first;
    while (last < series.size() && std::isfinite(series[last])) ++last;
    if (last > first) f(series.subspan(first, last - first));
    first = last + 1;
  }
}

// Sums from the start of a stretch, about its first value, so that a pedestal costs no digits.
std::vector<double> cumulative(std::span<const double> stretch) {
  std::vector<double> sums(stretch.size() + 1, 0.0);
  CompensatedSum sum;
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    sum.add(stretch[i] - stretch[0]);
    sums[i + 1] = sum.value();
  }
  return sums;
}

AllanDeviation deviation(std::span<const double> series, std::int64_t length, std::size_t step) {
  ASTROID_CHECK_LE(1, length);
  const auto m = static_cast<std::size_t>(length);
  AllanDeviation result{.length = length};
  CompensatedSum squares;
  for_each_stretch(series, [&](std::span<const double> stretch) {
    if (stretch.size() < 2 * m) return;
    const std::vector<double> x = cumulative(stretch);
    for (std::size_t i = 0; i + 2 * m <= stretch.size(); i += step) {
      const double difference = (x[i + 2 * m] - x[i + m]) - (x[i + m] - x[i]);
      squares.add(difference * difference);
      ++result.terms;
    }
  });
  if (result.terms > 0) {
    const auto size = static_cast<double>(length);
    result.value = std::sqrt(squares.value() / (2.0 * size * size * static_cast<double>(result.terms)));
  }
  return result;
}

}  // namespace

AllanDeviation allan_deviation(std::span<const double> series, std::int64_t length) {
  return deviation(series, length, static_cast<std::size_t>(length > 0 ? length : 1));
}

AllanDeviation overlapping_allan_deviation(std::span<const double> series, std::int64_t length) {
  return deviation(series, length, 1);
}

}  // namespace astroid
