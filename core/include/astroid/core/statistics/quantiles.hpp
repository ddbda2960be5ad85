// Quantiles that say how many values they rest on.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace astroid {

/// A quantile, and how many values it rests on. Values that are not a number are left out and counted.
struct Quantile {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN when `used` is 0
  std::size_t used = 0;
  std::size_t ignored = 0;
  [[nodiscard]] bool valid() const { return used > 0; }
};

/// Quantile p of the values by linear interpolation of the order statistics (Hyndman & Fan's type 7, as numpy's
/// default).
/// @param p  in [0, 1], else BugError. @source HyndmanFan1996.
Quantile quantile(std::span<const double> values, double p);
Quantile median(std::span<const double> values);

/// The same without a copy: leaves the values in another order, those that are not a number last.
/// @complexity O(n), no allocation
Quantile quantile_in_place(std::span<double> values, double p);
Quantile median_in_place(std::span<double> values);

}  // namespace astroid
