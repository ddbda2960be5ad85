// Deviations in standard errors and chi-squared probabilities, printed so that a reader sees how close a pass was.
#pragma once

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <span>
#include <string>

namespace astroid::test {

inline constexpr double kLargestZ = 5.0;              // 6e-7 by chance, for a seed that nobody chose
inline constexpr double kSmallestProbability = 1e-4;  // of chi-squared and Kolmogorov-Smirnov tests

inline void expect_within_errors(const std::string& what, double deviation, double standard_error) {
  const double z = deviation / standard_error;
  std::printf("  %-46s z = %+.2f\n", what.c_str(), z);
  EXPECT_LE(z, kLargestZ) << what;
  EXPECT_GE(z, -kLargestZ) << what;
}

inline void expect_probable(const std::string& what, double statistic, double probability) {
  std::printf("  %-46s statistic = %.2f, p = %.4f\n", what.c_str(), statistic, probability);
  EXPECT_GT(probability, kSmallestProbability) << what;
  EXPECT_LT(probability, 1.0 - kSmallestProbability) << what << ": too good to be random";
}

/// Pearson's test of counts against expectations that are all large enough (5).
inline void expect_chi_squared(const std::string& what, std::span<const double> observed,
                               std::span<const double> expected) {
  double chi2 = 0.0;
  for (std::size_t i = 0; i < observed.size(); ++i)
    chi2 += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
  expect_probable(what, chi2, gsl_cdf_chisq_Q(chi2, static_cast<double>(observed.size()) - 1.0));
}

}  // namespace astroid::test
