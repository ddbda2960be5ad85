// Is a sample Gaussian?
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace astroid {

/// Result of the Anderson-Darling test with mean and variance estimated from the sample.
struct AndersonDarling {
  double statistic = std::numeric_limits<double>::quiet_NaN();  ///< A^2 (1 + 0.75/n + 2.25/n^2)
  double p_value = std::numeric_limits<double>::quiet_NaN();    ///< of so large a statistic if the sample is Gaussian
  std::size_t used = 0;
};

/// Critical values of `statistic` at 10, 5, 2.5 and 1 %: 0.631, 0.752, 0.873, 1.035.
inline constexpr double kAndersonDarlingFivePercent = 0.752;

/// NaN for fewer than 8 finite values or none that differ. @source Stephens1986 (Table 4.9 and p-values).
AndersonDarling anderson_darling(std::span<const double> values);

}  // namespace astroid
