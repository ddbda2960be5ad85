// How well a standard deviation, or a median, is known.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace astroid {

/// A noise measured from a finite series, and how well: standard error and 95 % interval.
///
/// `value` is unbiased in the mean for Gaussian white noise (divided by c4). NaN where the series is too short.
struct NoiseEstimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error, value / sqrt(2 dof)
  double low = std::numeric_limits<double>::quiet_NaN();    ///< 95 % interval of chi-squared with `dof`
  double high = std::numeric_limits<double>::quiet_NaN();
  std::int64_t dof = 0;  ///< degrees of freedom of the variance
  /// The same noise in another unit.
  [[nodiscard]] NoiseEstimate scaled(double factor) const;
};

/// The mean of the sample standard deviation (n - 1 in the denominator) of n Gaussian values of unit variance.
/// @param n  >= 2.  @accuracy 1e-14 relative.
double c4(std::int64_t n);

/// The factors by which a sample standard deviation is multiplied to give the ends of the 95 % interval of sigma, and
/// the median of the sample standard deviation of unit noise.
struct DeviationInterval {
  double low = 0.0;
  double high = 0.0;
  double median = 1.0;
};
/// @param dof  >= 1.  @accuracy 1e-6 relative.  @source WilsonHilferty1931 from 1000 on, exact below.
DeviationInterval deviation_interval(std::int64_t dof);

/// Gives a sample standard deviation `sample` (n - 1 in the denominator) its error and interval.
NoiseEstimate noise_estimate(double sample, std::int64_t dof);

/// The median of finite values with the distribution-free 95 % interval of its order statistics.
struct MedianEstimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();  ///< equal to the extremes when there are fewer than 6 values
  double high = std::numeric_limits<double>::quiet_NaN();
  std::int64_t n = 0;
  /// Half the width of the interval, as a ± at 95 %.
  [[nodiscard]] double half_width() const { return 0.5 * (high - low); }
};
/// Values that are not finite are left out.
MedianEstimate median_estimate(std::span<const double> values);

/// Mean, scatter (n - 1) and standard error of the finite values. NaN where there are too few.
struct MeanEstimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();
  double scatter = std::numeric_limits<double>::quiet_NaN();
  std::int64_t n = 0;
};
MeanEstimate mean_estimate(std::span<const double> values);

}  // namespace astroid
