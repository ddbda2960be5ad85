// SCIENCE N1: the Poisson mean anywhere a pixel can have it, and where it cannot.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"

namespace astroid {
namespace {

constexpr std::uint64_t kFirst = 0;
constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMedian = 0x8000000000000000U;

TEST(PoissonOfAnyMean, IsZeroForZeroAndDenormalMeans) {
  for (const double mean :
       {0.0, -0.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::min(), 1e-100}) {
    for (const std::uint64_t word : {kFirst, kMedian, kLast}) {
      EXPECT_EQ(poisson_quantile(mean, word), 0.0) << mean;
      EXPECT_FALSE(std::signbit(poisson_quantile(mean, word))) << mean;
      EXPECT_EQ(poisson_quantile(mean, static_cast<std::uint32_t>(word >> 32U), [] { return 0xffffffffU; }), 0.0)
          << mean;
    }
  }
}

TEST(PoissonOfAnyMean, CountsOneElectronOnlyInTheLastWordsOfAMeanOf1e9th) {
  // P(X >= 1) = 9.999999995e-10 is 4.29 steps of 2^-32.
  EXPECT_EQ(poisson_quantile(1e-9, 0xfffffffbU, [] { return 0U; }), 0.0);
  EXPECT_EQ(poisson_quantile(1e-9, 0xfffffffcU, [] { return 0U; }), 1.0);
  EXPECT_EQ(poisson_quantile(1e-9, 0xfffffffbU, [] { return 0xffffffffU; }), 1.0);
  // P(X >= 2) = 5e-19 is 9.2 steps of 2^-64.
  EXPECT_EQ(poisson_quantile(1e-9, kLast - 10U), 1.0);
  EXPECT_EQ(poisson_quantile(1e-9, kLast - 8U), 2.0);
}

TEST(PoissonOfAnyMean, RefusesWhatIsNoMean) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double above = std::nextafter(kLargestPoissonMean, infinity);
  for (const double mean : {-1e-300, -1.0, std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, above}) {
    EXPECT_THROW(poisson_quantile(mean, kMedian), BugError) << mean;
    EXPECT_THROW(poisson_quantile(mean, 5U, [] { return 0U; }), BugError) << mean;
    EXPECT_THROW(poisson_cdf(1.0, mean), BugError) << mean;
    std::vector<double> means(100, 1300.0);
    std::vector<double> out(100);
    means[70] = mean;
    EXPECT_THROW(poisson_row({}, {}, means, out), BugError) << mean;
  }
}

TEST(PoissonOfAnyMean, ReachesThe1e15WithIntegersThatADoubleHolds) {
  const double sigma = std::sqrt(kLargestPoissonMean);
  const double lowest = poisson_quantile(kLargestPoissonMean, kFirst);
  const double median = poisson_quantile(kLargestPoissonMean, kMedian);
  const double highest = poisson_quantile(kLargestPoissonMean, kLast);
  EXPECT_EQ(median, kLargestPoissonMean);  // the median of a large integer mean is the mean
  EXPECT_NEAR((lowest - median) / sigma, -9.16, 0.01);
  EXPECT_NEAR((highest - median) / sigma, 9.16, 0.01);
  EXPECT_EQ(highest, std::floor(highest));
}

TEST(PoissonOfAnyMean, StaysInsideNineDeviationsAtTheEndsOfTheUniform) {
  for (double mean = 1e-9; mean < 2e14; mean *= 1.7) {
    const double sigma = std::sqrt(mean);
    const double lowest = poisson_quantile(mean, kFirst);
    const double highest = poisson_quantile(mean, kLast);
    EXPECT_GE(lowest, 0.0);
    EXPECT_LE(lowest, mean);
    EXPECT_GE(highest, std::floor(mean));
    EXPECT_LT(highest, mean + 9.2 * sigma + 20.0) << mean;  // the skew adds (w^2 + 2)/6 = 14 and a little
    EXPECT_GT(lowest, mean - 9.2 * sigma) << mean;
  }
}

TEST(PoissonTails, StayInRangeFarFromTheMean) {
  EXPECT_EQ(poisson_cdf(0.0, 1e15), 0.0);
  EXPECT_EQ(poisson_survival(0.0, 1e15), 1.0);
  EXPECT_EQ(poisson_cdf(1e15, 1.0), 1.0);
  EXPECT_EQ(poisson_survival(1e15, 1.0), 0.0);
  EXPECT_EQ(poisson_cdf(0.0, 0.0), 1.0);
  EXPECT_EQ(poisson_survival(0.0, 0.0), 0.0);
  EXPECT_EQ(poisson_cdf(1e4, 1e6), 0.0);
  EXPECT_EQ(poisson_survival(1e6, 1e4), 0.0);
  EXPECT_THROW(poisson_cdf(0.5, 1.0), BugError);
  EXPECT_THROW(poisson_survival(-1.0, 1.0), BugError);
}

}  // namespace
}  // namespace astroid
