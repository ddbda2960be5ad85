// Allan deviation of a series with gaps: how noise averages down with time.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace astroid {

/// Allan deviation at one averaging length.
struct AllanDeviation {
  std::int64_t length = 0;                                  ///< points averaged
  double value = std::numeric_limits<double>::quiet_NaN();  ///< unit of the series; NaN without terms
  std::int64_t terms = 0;                                   ///< pairs of neighbouring means that it rests on
  [[nodiscard]] bool valid() const { return terms > 0; }
};

/// Root of half the mean squared difference of consecutive means of `length` points.
///
/// White noise s falls as s / sqrt(m), flicker stays constant, a random walk rises as sqrt(m), a drift D per point is
/// D m / sqrt(2). Values that are not finite are gaps: no mean and no pair reaches across one; means start anew behind
/// it.
/// @param series  evenly spaced. @param length  >= 1, else BugError. @source Riley2008.
AllanDeviation allan_deviation(std::span<const double> series, std::int64_t length);

/// The same from every start, not only every length-th: more terms, correlated, a smaller error. @complexity O(n)
AllanDeviation overlapping_allan_deviation(std::span<const double> series, std::int64_t length);

}  // namespace astroid
