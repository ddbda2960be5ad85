#include "astroid/core/statistics/allan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(AllanDeviation, ReproducesTheNbsTestData) {
  const std::vector<double> nbs14 = {892, 809, 823, 798, 671, 644, 883, 903, 677};
  EXPECT_NEAR(allan_deviation(nbs14, 1).value, 91.2294497, 5e-8);
  EXPECT_NEAR(allan_deviation(nbs14, 2).value, 115.8082107, 5e-8);
  EXPECT_NEAR(overlapping_allan_deviation(nbs14, 2).value, 85.9528698, 5e-8);
  EXPECT_EQ(overlapping_allan_deviation(nbs14, 2).terms, 6);
}

TEST(AllanDeviation, OfADriftRisesWithTheLength) {
  std::vector<double> drift(100);
  for (std::size_t i = 0; i < drift.size(); ++i) drift[i] = 1e6 + 0.25 * static_cast<double>(i);
  for (const std::int64_t m : {1, 3, 10}) {
    const double expected = 0.25 * static_cast<double>(m) / std::sqrt(2.0);
    EXPECT_NEAR(allan_deviation(drift, m).value, expected, 1e-12);
    EXPECT_NEAR(overlapping_allan_deviation(drift, m).value, expected, 1e-12);
  }
}

TEST(AllanDeviation, LetsNoPairReachAcrossAGap) {
  // A step of 100 hidden in a gap must not be seen.
  std::vector<double> series;
  for (int i = 0; i < 10; ++i) series.push_back(i % 2);
  series.push_back(kNan);
  for (int i = 0; i < 10; ++i) series.push_back(100.0 + i % 2);
  EXPECT_NEAR(allan_deviation(series, 1).value, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(allan_deviation(series, 1).terms, 18);
  EXPECT_NEAR(allan_deviation(series, 2).value, 0.0, 1e-12);
  EXPECT_EQ(overlapping_allan_deviation(series, 5).terms, 2);
  EXPECT_FALSE(allan_deviation(series, 6).valid());
}

TEST(AllanDeviation, OfTooFewPointsSaysSo) {
  const std::vector<double> one = {1.0};
  EXPECT_FALSE(allan_deviation(one, 1).valid());
  EXPECT_TRUE(std::isnan(allan_deviation(one, 1).value));
  EXPECT_FALSE(overlapping_allan_deviation({}, 3).valid());
  EXPECT_THROW(static_cast<void>(allan_deviation(one, 0)), BugError);
}

}  // namespace
}  // namespace astroid
