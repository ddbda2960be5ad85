#include "astroid/analysis/confidence.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/statistics/sums.hpp"

namespace astroid {

namespace {

constexpr double kLowerTail = 0.025;                   // of a 95 % interval
constexpr double kNormalQuantile = 1.959963984540054;  // of 1 - kLowerTail
// From here Wilson and Hilferty's cube is good to 1e-6, and does not iterate.
constexpr std::int64_t kManyDegrees = 1000;

double wilson_hilferty(double z, double dof) {
  const double a = 2.0 / (9.0 * dof);  // Eq. of the cube-root transform
  const double root = 1.0 - a + z * std::sqrt(a);
  return dof * root * root * root;
}

}  // namespace

NoiseEstimate NoiseEstimate::scaled(double factor) const {
  return {value * factor, error * factor, low * factor, high * factor, dof};
}

double c4(std::int64_t n) {
  ASTROID_CHECK_LE(2, n);
  // c4(n) = sqrt(2/(n-1)) Gamma(n/2) / Gamma((n-1)/2). Below the series is not good enough; the recursion
  // c4(n) c4(n+1) = sqrt((n-1)/n) brings n up to where it is.
  constexpr std::int64_t kSeriesFrom = 64;
  if (n < kSeriesFrom) {
    return std::sqrt(static_cast<double>(n - 1) / static_cast<double>(n)) / c4(n + 1);
  }
  // Asymptotic series of the ratio of gamma functions in u = 1/(n - 1): the next term is below 1e-15 from n = 64 on.
  const double u = 1.0 / static_cast<double>(n - 1);
  const double series =
      1.0 +
      u * (-1.0 / 4 +
           u * (1.0 / 32 + u * (5.0 / 128 + u * (-21.0 / 2048 +
                                                 u * (-399.0 / 8192 + u * (869.0 / 65536 + u * (39325.0 / 262144)))))));
  return series;
}

namespace {

DeviationInterval calculated_interval(std::int64_t dof) {
  const double k = static_cast<double>(dof);
  if (dof >= kManyDegrees) {
    return {std::sqrt(k / wilson_hilferty(kNormalQuantile, k)), std::sqrt(k / wilson_hilferty(-kNormalQuantile, k)),
            std::sqrt(wilson_hilferty(0.0, k) / k)};
  }
  return {std::sqrt(k / gsl_cdf_chisq_Qinv(kLowerTail, k)), std::sqrt(k / gsl_cdf_chisq_Pinv(kLowerTail, k)),
          std::sqrt(gsl_cdf_chisq_Pinv(0.5, k) / k)};
}

}  // namespace

DeviationInterval deviation_interval(std::int64_t dof) {
  ASTROID_CHECK_LE(1, dof);
  // Inverting chi-squared takes microseconds, and most stars of a run share their degrees of freedom.
  struct Known {
    std::int64_t dof = 0;
    DeviationInterval interval;
  };
  constexpr std::size_t kKnown = 64;
  thread_local std::array<Known, kKnown> known;
  Known& entry = known[static_cast<std::size_t>(dof) % kKnown];
  if (entry.dof != dof) entry = {dof, calculated_interval(dof)};
  return entry.interval;
}

NoiseEstimate noise_estimate(double sample, std::int64_t dof) {
  if (dof < 1) return {};
  const DeviationInterval interval = deviation_interval(dof);
  const double value = sample / c4(dof + 1);
  return {value, value / std::sqrt(2.0 * static_cast<double>(dof)), sample * interval.low, sample * interval.high, dof};
}

MedianEstimate median_estimate(std::span<const double> values) {
  std::vector<double> finite;
  finite.reserve(values.size());
  for (const double v : values) {
    if (std::isfinite(v)) finite.push_back(v);
  }
  if (finite.empty()) return {};
  std::sort(finite.begin(), finite.end());
  const std::size_t n = finite.size();
  MedianEstimate out;
  out.n = static_cast<std::int64_t>(n);
  out.value = n % 2 == 1 ? finite[n / 2] : 0.5 * (finite[n / 2 - 1] + finite[n / 2]);
  // Order statistics j and n+1-j enclose the median with probability 1 - 2 P(Binomial(n, 1/2) < j).
  std::size_t j = 1;
  while (2 * (j + 1) <= n + 1 &&
         gsl_cdf_binomial_P(static_cast<unsigned>(j), 0.5, static_cast<unsigned>(n)) <= kLowerTail) {
    ++j;
  }
  out.low = finite[j - 1];
  out.high = finite[n - j];
  return out;
}

MeanEstimate mean_estimate(std::span<const double> values) {
  RunningMoments moments;
  for (const double v : values) {
    if (std::isfinite(v)) moments.add(v);
  }
  MeanEstimate out;
  out.n = moments.count();
  out.value = moments.mean();
  out.scatter = moments.standard_deviation();
  out.error = out.scatter / std::sqrt(static_cast<double>(out.n));
  return out;
}

}  // namespace astroid
