#include "astroid/core/statistics/gaussianity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/statistics/sums.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

// P-value of the modified statistic when mean and variance are estimated. @source Stephens1986
double p_value_of(double a) {
  constexpr double kSmallest = 100.0;  // statistic at which the fit to the p-values, then 1e-167, ends to fall
  if (a >= kSmallest) return 0.0;
  if (a >= 0.6) return det::exp(1.2937 - 5.709 * a + 0.0186 * a * a);
  if (a >= 0.34) return det::exp(0.9177 - 4.279 * a - 1.38 * a * a);
  if (a >= 0.2) return 1.0 - det::exp(-8.318 + 42.796 * a - 59.938 * a * a);
  return 1.0 - det::exp(-13.436 + 101.14 * a - 223.73 * a * a);
}

}  // namespace

AndersonDarling anderson_darling(std::span<const double> values) {
  std::vector<double> sorted;
  RunningMoments moments;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sorted.push_back(value);
    moments.add(value);
  }
  std::sort(sorted.begin(), sorted.end());
  AndersonDarling result;
  result.used = sorted.size();
  constexpr std::size_t kFewest = 8;
  const double deviation = moments.standard_deviation();
  if (result.used < kFewest || !(deviation > 0.0)) return result;
  const auto n = static_cast<double>(result.used);
  const double scale = 1.0 / (std::sqrt(2.0) * deviation);
  // ln Phi(z) from erfc on its own side, so that an outlier costs no digits; beyond erfc's range its asymptote.
  const auto log_phi = [](double z) {
    constexpr double kFar = 26.0;
    if (z > -kFar) return det::log(0.5 * det::erfc(-z));
    return -z * z - det::log(-z) - 0.5 * det::log(4.0 * kPi);
  };
  CompensatedSum sum;
  for (std::size_t i = 0; i < result.used; ++i) {
    const double lower = (sorted[i] - moments.mean()) * scale;
    const double upper = (sorted[result.used - 1 - i] - moments.mean()) * scale;
    sum.add((2.0 * static_cast<double>(i) + 1.0) * (log_phi(lower) + log_phi(-upper)));
  }
  const double a = -n - sum.value() / n;
  result.statistic = a * (1.0 + 0.75 / n + 2.25 / (n * n));
  result.p_value = std::clamp(p_value_of(result.statistic), 0.0, 1.0);
  return result;
}

}  // namespace astroid
