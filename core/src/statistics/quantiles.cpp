#include "astroid/core/statistics/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {

Quantile quantile_in_place(std::span<double> values, double p) {
  ASTROID_CHECK_LE(0.0, p);
  ASTROID_CHECK_LE(p, 1.0);
  const auto numbers_end = std::partition(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
  Quantile result;
  result.used = static_cast<std::size_t>(numbers_end - values.begin());
  result.ignored = values.size() - result.used;
  if (result.used == 0) return result;
  const double position = p * static_cast<double>(result.used - 1);
  const auto below = static_cast<std::ptrdiff_t>(position);
  const auto at = values.begin() + below;
  std::nth_element(values.begin(), at, numbers_end);
  result.value = *at;
  const double share = position - static_cast<double>(below);
  if (share > 0.0) {
    const double above = *std::min_element(at + 1, numbers_end);
    if (above != result.value) result.value += share * (above - result.value);  // equal infinities stay themselves
  }
  return result;
}

Quantile median_in_place(std::span<double> values) {
  constexpr double kHalf = 0.5;
  return quantile_in_place(values, kHalf);
}

Quantile quantile(std::span<const double> values, double p) {
  std::vector<double> copy(values.begin(), values.end());
  return quantile_in_place(copy, p);
}

Quantile median(std::span<const double> values) {
  std::vector<double> copy(values.begin(), values.end());
  return median_in_place(copy);
}

}  // namespace astroid
