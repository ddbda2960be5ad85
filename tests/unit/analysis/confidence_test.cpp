#include "astroid/analysis/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace astroid {
namespace {

TEST(Confidence, KnowsTheMeanOfTheSampleDeviation) {
  EXPECT_NEAR(c4(2), std::sqrt(2.0 / 3.14159265358979323846), 1e-14);
  EXPECT_NEAR(c4(3), 0.5 * std::sqrt(3.14159265358979323846), 1e-14);
  EXPECT_NEAR(c4(4), 2.0 * std::sqrt(2.0 / (3.0 * 3.14159265358979323846)), 1e-14);
  // An hour of 144 exposures, with n - 1 and with n in the denominator.
  EXPECT_NEAR(c4(144), 0.9982533, 5e-8);
  EXPECT_NEAR(c4(144) * std::sqrt(143.0 / 144.0), 0.9947811, 5e-8);
}

TEST(Confidence, GivesTheIntervalOfChiSquared) {
  // chi-squared quantiles of 10 degrees of freedom: 3.246973, 9.341818, 20.483177 (tables).
  const DeviationInterval ten = deviation_interval(10);
  EXPECT_NEAR(ten.low, std::sqrt(10.0 / 20.483177), 1e-7);
  EXPECT_NEAR(ten.high, std::sqrt(10.0 / 3.246973), 1e-7);
  EXPECT_NEAR(ten.median, std::sqrt(9.341818 / 10.0), 1e-7);
}

TEST(Confidence, HasNoStepWhereTheApproximationOfTheIntervalBegins) {
  // One more degree moves the ends by 2e-5, and the next by 0.15 % less.
  const DeviationInterval d998 = deviation_interval(998);
  const DeviationInterval d999 = deviation_interval(999);
  const DeviationInterval d1000 = deviation_interval(1000);
  EXPECT_NEAR(d1000.low - d999.low, d999.low - d998.low, 1e-6);
  EXPECT_NEAR(d1000.high - d999.high, d999.high - d998.high, 1e-6);
  EXPECT_NEAR(d1000.median - d999.median, d999.median - d998.median, 1e-6);
}

TEST(Confidence, GivesNothingWithoutDegreesOfFreedom) {
  EXPECT_TRUE(std::isnan(noise_estimate(1.0, 0).value));
}

TEST(Confidence, BoundsTheMedianByOrderStatistics) {
  // For ten values the second and the ninth enclose the median with 97.9 %, the third and eighth with 89 % only.
  std::vector<double> ten{10, 9, 8, 7, 6, 5, 4, 3, 2, 1};
  MedianEstimate m = median_estimate(ten);
  EXPECT_EQ(m.value, 5.5);
  EXPECT_EQ(m.low, 2.0);
  EXPECT_EQ(m.high, 9.0);
  ten.push_back(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(median_estimate(ten).n, 10);
}

TEST(Confidence, TakesTheExtremesOfAFewValuesAsBounds) {
  const std::vector<double> three{3.0, 1.0, 2.0};
  const MedianEstimate m = median_estimate(three);
  EXPECT_EQ(m.value, 2.0);
  EXPECT_EQ(m.low, 1.0);
  EXPECT_EQ(m.high, 3.0);
  EXPECT_TRUE(std::isnan(median_estimate({}).value));
}

TEST(Confidence, AveragesOnAPedestalWithoutCancellation) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(1e9 + i % 2);
  const MeanEstimate m = mean_estimate(values);
  EXPECT_DOUBLE_EQ(m.value, 1e9 + 0.5);
  EXPECT_NEAR(m.scatter, 0.5 * std::sqrt(1000.0 / 999.0), 1e-9);
}

}  // namespace
}  // namespace astroid
