// Hard cases N14, N15, N26, N27, N28 and N35: pedestals, long sums, not-a-number, samples without spread.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/core/statistics/regression.hpp"
#include "astroid/core/statistics/robust.hpp"
#include "astroid/core/statistics/sums.hpp"

namespace astroid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(RunningMoments, KeepTheVarianceOnAPedestal) {
  RunningMoments serial;
  for (int i = 0; i < 1000000; ++i) serial.add(1e9 + i % 2);
  EXPECT_NEAR(serial.population_variance() / 0.25, 1.0, 1e-9);
  EXPECT_NEAR(serial.mean(), 1e9 + 0.5, 1e-6);
}

TEST(RunningMoments, OfFixedChunksHaveTheSameBitsHoweverTheyAreComputed) {
  constexpr int kChunks = 16;
  constexpr int kChunk = 1000;
  const auto chunk = [](int c) {
    RunningMoments moments;
    for (int i = 0; i < kChunk; ++i) moments.add(1e9 + std::fmod((c * kChunk + i) * 0.618, 1.0));
    return moments;
  };
  std::vector<RunningMoments> backwards(kChunks);
  for (int c = kChunks; c-- > 0;) backwards[static_cast<std::size_t>(c)] = chunk(c);
  RunningMoments a;
  RunningMoments b;
  for (int c = 0; c < kChunks; ++c) {
    a.merge(chunk(c));
    b.merge(backwards[static_cast<std::size_t>(c)]);
  }
  EXPECT_EQ(a.variance(), b.variance());
  EXPECT_EQ(a.mean(), b.mean());
  EXPECT_NEAR(a.variance() * 12.0, 1.0, 1e-2);
}

TEST(PairwiseSum, OfThirtyMillionOnesIsExact) {
  const std::vector<float> ones(30000000, 1.0F);
  EXPECT_EQ(pairwise_sum(ones), 3e7);
}

TEST(PairwiseSum, LosesLessThanALoop) {
  const std::vector<double> tenths(1 << 20, 0.1);
  const double exact = 0.1 * (1 << 20);             // a power of two times the double 0.1
  EXPECT_NEAR(pairwise_sum(tenths), exact, 5e-10);  // 20 ulp
  double loop = 0.0;
  for (const double x : tenths) loop += x;
  EXPECT_GT(std::abs(loop - exact), 1e-8);
}

TEST(CompensatedSum, KeepsWhatAHugeTermHides) {
  CompensatedSum sum;
  for (const double x : {1.0, 1e100, 1.0, -1e100}) sum.add(x);
  EXPECT_EQ(sum.value(), 2.0);
}

TEST(Quantile, LeavesOutWhatIsNotANumber) {
  const Quantile result = median(std::vector<double>{1.0, kNan, 3.0});
  EXPECT_EQ(result.value, 2.0);
  EXPECT_EQ(result.used, 2U);
  EXPECT_EQ(result.ignored, 1U);
  EXPECT_TRUE(result.valid());
}

TEST(Quantile, OfNothingSaysSo) {
  for (const std::vector<double>& values : {std::vector<double>{}, std::vector<double>{kNan, kNan}}) {
    EXPECT_TRUE(std::isnan(median(values).value));
    EXPECT_FALSE(median(values).valid());
  }
}

TEST(Quantile, OfOneValueIsThatValue) {
  for (const double p : {0.0, 0.3, 0.5, 1.0}) EXPECT_EQ(quantile(std::vector<double>{5.0}, p).value, 5.0);
}

TEST(Quantile, RefusesAProbabilityThatIsNone) {
  for (const double p : {-1e-9, 1.0000001, kNan}) {
    EXPECT_THROW(static_cast<void>(quantile(std::vector<double>{1.0}, p)), BugError);
  }
}

TEST(Quantile, TakesInfinitiesAsValues) {
  EXPECT_EQ(median(std::vector<double>{kInfinity, 1.0, kInfinity, kInfinity}).value, kInfinity);
  EXPECT_EQ(median(std::vector<double>{-kInfinity, 1.0, kInfinity}).value, 1.0);
}

TEST(SigmaClip, OfEqualValuesClipsNothing) {
  const ClippedSample sample = sigma_clip(std::vector<double>(1000, 0.1));
  EXPECT_EQ(sample.clipped, 0U);
  EXPECT_EQ(sample.mean, 0.1);
  EXPECT_EQ(sample.deviation, 0.0);
}

TEST(SigmaClip, FindsTheOneOutlierAmongTenThousandEqualValues) {
  std::vector<double> values(10000, 7.0);
  values[1234] = 8.0;
  const ClippedSample sample = sigma_clip(values);
  EXPECT_EQ(sample.clipped, 1U);
  EXPECT_EQ(sample.mean, 7.0);
  EXPECT_EQ(sample.deviation, 0.0);
}

TEST(SigmaClip, OfNothingSaysSo) {
  const ClippedSample sample = sigma_clip(std::vector<double>{kNan, kNan});
  EXPECT_EQ(sample.kept, 0U);
  EXPECT_EQ(sample.ignored, 2U);
  EXPECT_TRUE(std::isnan(sample.mean));
  EXPECT_TRUE(std::isnan(background_mode(sample)));
}

TEST(RobustSpread, OfQuantisedValuesFallsBackAndSaysSo) {
  const RobustSpread spread = robust_spread(std::vector<double>{0, 0, 0, 0, 0, 0, 1, 1, 1, 1});
  EXPECT_TRUE(spread.fell_back);
  EXPECT_NEAR(spread.value, std::sqrt(2.4 / 9.0), 1e-15);
  const RobustSpread equal = robust_spread(std::vector<double>(5, 3.0));
  EXPECT_TRUE(equal.fell_back);
  EXPECT_EQ(equal.value, 0.0);
  EXPECT_TRUE(std::isnan(robust_spread({}).value));
}

TEST(RobustSpread, IgnoresOutliersAndNotANumber) {
  const RobustSpread spread = robust_spread(std::vector<double>{1, 2, 3, 4, 1e30, kNan});
  EXPECT_FALSE(spread.fell_back);
  EXPECT_EQ(spread.centre, 3.0);
  EXPECT_NEAR(spread.value, 1.4826, 1e-4);
  EXPECT_EQ(spread.ignored, 1U);
}

TEST(PolynomialTrend, RemovesAQuadraticFarFromTheOrigin) {
  std::vector<double> t;
  std::vector<double> y;
  const double start = 2.457e6;  // a Julian date, days
  const auto trend = [](double days) { return 1.0 + 0.02 * days - 3e-4 * days * days; };
  for (int i = 0; i < 2000; ++i) {
    const double days = i * 0.015625;  // exact steps, so that the dates are as well
    t.push_back(start + days);
    y.push_back(trend(days));
  }
  const PolynomialTrend fit(t, y, 2);
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(fit(t[i]) / y[i], 1.0, 1e-10);
  EXPECT_NEAR(fit(start + 40.0) / trend(40.0), 1.0, 1e-10);
}

TEST(PolynomialTrend, LowersItsDegreeToWhatTheDataAllow) {
  const std::vector<double> x = {1, 1, 2, 2, kNan};
  const std::vector<double> y = {3, 5, 6, 8, 9};
  const PolynomialTrend line(x, y, 5);
  EXPECT_EQ(line.degree(), 1);
  EXPECT_NEAR(line(1.0), 4.0, 1e-14);
  EXPECT_NEAR(line(2.0), 7.0, 1e-14);
  EXPECT_EQ(PolynomialTrend({}, {}, 2).degree(), -1);
  EXPECT_TRUE(std::isnan(PolynomialTrend({}, {}, 2)(1.0)));
}

}  // namespace
}  // namespace astroid
