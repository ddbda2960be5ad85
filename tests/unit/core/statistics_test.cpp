#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/statistics/gaussianity.hpp"
#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/core/statistics/regression.hpp"
#include "astroid/core/statistics/robust.hpp"
#include "astroid/core/statistics/sums.hpp"

namespace astroid {
namespace {

TEST(RunningMoments, AgreeWithTheDefinition) {
  RunningMoments moments;
  for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) moments.add(x);
  EXPECT_EQ(moments.count(), 8);
  EXPECT_DOUBLE_EQ(moments.mean(), 5.0);
  EXPECT_DOUBLE_EQ(moments.population_variance(), 4.0);
  EXPECT_DOUBLE_EQ(moments.variance(), 32.0 / 7.0);
}

TEST(RunningMoments, OfTooFewValuesAreNotANumber) {
  RunningMoments moments;
  EXPECT_TRUE(std::isnan(moments.mean()));
  moments.add(3.0);
  EXPECT_EQ(moments.mean(), 3.0);
  EXPECT_TRUE(std::isnan(moments.variance()));
}

TEST(RunningMoments, MergeIntoThoseOfTheWhole) {
  RunningMoments whole;
  RunningMoments left;
  RunningMoments right;
  for (int i = 0; i < 100; ++i) {
    const double x = std::sin(i) + i;
    whole.add(x);
    (i < 37 ? left : right).add(x);
  }
  left.merge(right);
  left.merge(RunningMoments{});
  EXPECT_EQ(left.count(), 100);
  EXPECT_NEAR(left.mean(), whole.mean(), 1e-13);
  EXPECT_NEAR(left.variance(), whole.variance(), 1e-11);
  RunningMoments empty;
  empty.merge(whole);
  EXPECT_EQ(empty.mean(), whole.mean());
}

TEST(VarianceRelativeError, KnowsChiSquaredAndPoisson) {
  EXPECT_DOUBLE_EQ(variance_relative_error(201), 0.1);
  EXPECT_NEAR(variance_relative_error(400000, 3.0), std::sqrt((2.0 + 1.0 / 3.0) / 400000), 1e-8);
}

TEST(Quantile, InterpolatesAsTypeSeven) {
  const std::vector<double> values = {7.0, 1.0, 3.0, 10.0};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0).value, 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0).value, 10.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5).value, 5.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25).value, 2.5);
  EXPECT_DOUBLE_EQ(quantile(values, 0.9).value, 9.1);
}

TEST(ClippedDeviationFactor, ReproducesReferenceValues) {
  EXPECT_NEAR(clipped_deviation_factor(2.5), 0.954597, 5e-7);
  EXPECT_NEAR(clipped_deviation_factor(3.0), 0.986578, 5e-7);
  EXPECT_NEAR(clipped_deviation_factor(4.0), 0.999465, 5e-7);
  EXPECT_NEAR(clipped_deviation_factor(5.0), 0.9999926, 5e-8);
  EXPECT_NEAR(clipped_deviation_factor(2.326347874040841), 0.9345935, 5e-8);  // the trim of 1 to 99 %
}

TEST(SigmaClip, RemovesOutliersOnTheirSides) {
  std::vector<double> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i));
  values[17] = 50.0;
  values[18] = -70.0;
  values[19] = std::numeric_limits<double>::quiet_NaN();
  const ClippedSample both = sigma_clip(values);
  EXPECT_EQ(both.clipped, 2U);
  EXPECT_EQ(both.ignored, 1U);
  EXPECT_EQ(both.kept, 997U);
  EXPECT_LE(both.highest, 1.0);
  EXPECT_NEAR(both.deviation, std::sqrt(0.5), 1e-2);
  const ClippedSample high = sigma_clip(values, {.low = 1e9, .high = 3.0});
  EXPECT_EQ(high.lowest, -70.0);
  EXPECT_LE(high.highest, 1.0);
}

TEST(BackgroundMode, IsBelowTheMedianOfASkewedSample) {
  ClippedSample sample;
  sample.mean = 10.2;
  sample.median = 10.0;
  sample.deviation = 2.0;
  EXPECT_DOUBLE_EQ(background_mode(sample), 2.5 * 10.0 - 1.5 * 10.2);
  sample.deviation = 0.5;  // too skewed for the formula
  EXPECT_EQ(background_mode(sample), 10.0);
}

TEST(HalfSampleMode, FindsTheDensestPlace) {
  EXPECT_DOUBLE_EQ(half_sample_mode(std::vector<double>{1.0, 5.0, 5.125, 5.1875, 20.0, 40.0, 90.0}), 5.15625);
  EXPECT_DOUBLE_EQ(half_sample_mode(std::vector<double>{3.0}), 3.0);
  EXPECT_TRUE(std::isnan(half_sample_mode({})));
  std::vector<double> sky(600, 0.0);
  for (std::size_t i = 0; i < sky.size(); ++i) {
    const double u = (static_cast<double>(i) + 0.5) / 600.0;
    sky[i] = i % 3 == 0 ? 100.0 + 900.0 * u : 100.0 + 10.0 * (u - 0.5);  // a third of the pixels hold stars
  }
  EXPECT_NEAR(half_sample_mode(sky), 100.0, 5.0);
}

TEST(FitLine, ReproducesAKnownRegression) {
  // Anscombe's first quartet: y = 3.0001 + 0.5001 x, standard errors 1.1247 and 0.1179.
  const std::vector<double> x = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  const std::vector<double> y = {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  const Line line = fit_line(x, y);
  EXPECT_NEAR(line(0.0), 3.0001, 5e-5);
  EXPECT_NEAR(line.slope, 0.5001, 5e-5);
  EXPECT_NEAR(line.slope_error, 0.1179, 5e-5);
  EXPECT_NEAR(line.scatter, 1.2366, 5e-5);
  EXPECT_NEAR(std::hypot(line.at_centre_error, line.centre * line.slope_error), 1.1247, 5e-5);
}

TEST(FitLine, LeavesOutPointsWithoutWeightOrValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x = {0, 1, 2, 3, 4};
  const std::vector<double> y = {1, 3, nan, 7, 100};
  const std::vector<double> w = {1, 2, 1, 3, 0};
  const Line line = fit_line(x, y, w);
  EXPECT_EQ(line.used, 3U);
  EXPECT_NEAR(line.slope, 2.0, 1e-14);
  EXPECT_NEAR(line(0.0), 1.0, 1e-14);
  EXPECT_TRUE(std::isnan(fit_line(std::vector<double>{1, 1}, std::vector<double>{2, 3}).slope));
}

TEST(AndersonDarling, OfGaussianQuantilesIsSmallAndOfUniformOnesLarge) {
  std::vector<double> uniform;
  std::vector<double> heavy;
  for (int i = 0; i < 400; ++i) {
    const double u = (i + 0.5) / 400.0;
    uniform.push_back(u);
    heavy.push_back(std::log(u / (1.0 - u)));
  }
  EXPECT_GT(anderson_darling(uniform).statistic, kAndersonDarlingFivePercent);
  EXPECT_LT(anderson_darling(uniform).p_value, 0.01);
  EXPECT_GT(anderson_darling(heavy).statistic,
            anderson_darling(std::vector<double>(heavy.begin() + 100, heavy.end() - 100)).statistic / 10);
  EXPECT_TRUE(std::isnan(anderson_darling(std::vector<double>(20, 1.0)).statistic));
  EXPECT_TRUE(std::isnan(anderson_darling(std::vector<double>{1, 2, 3}).statistic));
}

TEST(AndersonDarling, ReproducesAnIndependentComputation) {
  // Weights of 11 men in pounds, Shapiro and Wilk's example: A^2 = 0.9468 (mean and variance estimated), as printed by
  // D'Agostino and Stephens for this set; times 1 + 0.75/n + 2.25/n^2.
  const std::vector<double> weights = {148, 154, 158, 160, 161, 162, 166, 170, 182, 195, 236};
  const AndersonDarling result = anderson_darling(weights);
  EXPECT_NEAR(result.statistic / (1.0 + 0.75 / 11 + 2.25 / 121), 0.947, 1e-3);
  EXPECT_LT(result.p_value, 0.025);
}

}  // namespace
}  // namespace astroid
