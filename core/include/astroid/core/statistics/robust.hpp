// Centre and spread of samples that are not all of one kind.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace astroid {

/// Spread of a sample by a robust estimator, consistent with the standard deviation for Gaussian values.
struct RobustSpread {
  double centre = std::numeric_limits<double>::quiet_NaN();  ///< median
  double value = std::numeric_limits<double>::quiet_NaN();   ///< standard deviation; NaN without values
  bool fell_back = false;  ///< more than half the values are equal: the trimmed standard deviation instead
  std::size_t used = 0;
  std::size_t ignored = 0;  ///< not a number
};

/// 1.4826 times the median absolute deviation from the median.
///
/// When that is zero, because the values are quantised, the standard deviation of the central 98 % over 0.9346 takes
/// its place and `fell_back` says so; it too is zero if (nearly) all values are equal: never divide by it unseen.
RobustSpread robust_spread(std::span<const double> values);

/// Options of sigma clipping.
struct ClipRule {
  double low = 3.0;          ///< standard deviations below the centre
  double high = 3.0;         ///< standard deviations above
  int passes = 10;           ///< at most
  bool about_median = true;  ///< of the kept values; else about their mean
};

/// What is left after sigma clipping.
struct ClippedSample {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double median = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< n - 1; biased low, see clipped_deviation_factor()
  double lowest = std::numeric_limits<double>::quiet_NaN();     ///< kept are lowest <= value <= highest
  double highest = std::numeric_limits<double>::quiet_NaN();
  std::size_t kept = 0;
  std::size_t clipped = 0;
  std::size_t ignored = 0;  ///< not a number
  int passes = 0;
};

/// Removes values more than k standard deviations from the centre until none is, the deviation is zero or the passes
/// are used up. Values exactly at k deviations stay, so equal values are never clipped.
ClippedSample sigma_clip(std::span<const double> values, const ClipRule& rule = {});

/// Standard deviation of Gaussian values after one clip at +-k standard deviations, relative to that without:
/// sqrt(1 - 2 k phi(k) / (2 Phi(k) - 1)), 0.986578 for 3.
double clipped_deviation_factor(double k);

/// Mode of a clipped background sample: 2.5 median - 1.5 mean, or the median where the two differ by more than 0.3
/// deviations, which is a sign of crowding. @source BertinArnouts1996.
double background_mode(const ClippedSample& sample);

/// Half-sample mode: the densest half of the densest half ... of the values. Robust to 50 % contamination from one
/// side. NaN without values. @source BickelFruehwirth2006. @complexity O(n log n)
double half_sample_mode(std::span<const double> values);

}  // namespace astroid
