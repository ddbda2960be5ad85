#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "csv_rows.hpp"
#include "poisson_oracle.hpp"
#include "poisson_quantile.hpp"

namespace astroid {
namespace {

constexpr double kTailTolerance = 3e-14;  // as stated in distributions.hpp

TEST(PoissonTails, MatchMpmath) {
  int compared = 0;
  double worst = 0.0;
  for (const auto& row : test::csv_rows("poisson_tails.csv")) {
    const double mean = std::stod(row[0]);
    const double n = std::stod(row[1]);
    const auto check = [&](double value, long double expected, const char* side) {
      const auto error = static_cast<double>(std::fabs(static_cast<long double>(value) / expected - 1.0L));
      EXPECT_LE(error, kTailTolerance) << side << " of n " << n << ", mean " << mean;
      worst = std::max(worst, error);
    };
    check(poisson_cdf(n, mean), std::stold(row[2]), "lower tail");
    check(poisson_survival(n, mean), std::stold(row[3]), "upper tail");
    ++compared;
  }
  EXPECT_GT(compared, 300);
  RecordProperty("worst relative error", std::to_string(worst * 1e14) + "e-14");
}

TEST(PoissonTails, MatchThePlainSum) {
  for (const double mean : {0.2, 5.0, 9.99, 10.0, 33.3, 9999.0, 1e4, 10001.0, 123456.7, 1e6}) {
    const test::PoissonOracle oracle(mean);
    const double step = std::max(1.0, std::floor(std::sqrt(mean) / 20.0));
    for (double n = oracle.first(); n < oracle.last(); n += step) {
      if (oracle.lower(n) > 1e-30L) {
        ASSERT_NEAR(poisson_cdf(n, mean) / static_cast<double>(oracle.lower(n)), 1.0, 1e-13) << mean << ' ' << n;
      }
      if (oracle.upper(n) > 1e-30L) {
        ASSERT_NEAR(poisson_survival(n, mean) / static_cast<double>(oracle.upper(n)), 1.0, 1e-13) << mean << ' ' << n;
      }
    }
  }
}

/// Words that a generator would rarely give, and a regular sample of the rest.
std::vector<std::uint64_t> words() {
  std::vector<std::uint64_t> all = {0U, 1U, 0xffffffffU, 0x100000000U, 0x7fffffffffffffffU, 0x8000000000000000U};
  for (unsigned bit = 0; bit < 63; ++bit) all.push_back(std::uint64_t{3} << bit);
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;  // multiples fill the range evenly
  for (std::uint64_t i = 1; i <= 20000; ++i) all.push_back(i * kGolden);
  const std::size_t count = all.size();
  for (std::size_t i = 0; i < count; ++i) all.push_back(~all[i]);
  return all;
}

double draw(double mean, std::uint64_t word) {
  return poisson_quantile(mean, static_cast<std::uint32_t>(word >> 32U),
                          [word] { return static_cast<std::uint32_t>(word); });
}

TEST(PoissonQuantile, MatchesTheSearchInThePlainSum) {
  constexpr long double kSlack = 1e-13L;  // of the tail: the stated accuracy and that of the oracle
  const std::vector<std::uint64_t> all = words();
  for (const double mean : {1e-9, 1e-3, 0.3,  1.0,    2.5,   7.0,   9.9999, 10.0,   10.5,    11.9,    12.1,
                            17.0, 30.0, 64.0, 100.25, 700.0, 800.0, 1300.0, 9999.5, 10000.5, 65536.0, 1e6}) {
    const test::PoissonOracle oracle(mean);
    for (const std::uint64_t word : all) {
      const double n = draw(mean, word);
      ASSERT_GE(n, oracle.quantile(word, kSlack)) << "mean " << mean << " word " << word;
      ASSERT_LE(n, oracle.quantile(word, -kSlack)) << "mean " << mean << " word " << word;
    }
  }
}

TEST(PoissonQuantile, InvertsTheDistributionFunctionForEveryMean) {
  const std::vector<std::uint64_t> all = words();
  for (const double mean : {1e-300, 1e-9, 0.5, 10.0, 150.0, 2e4, 3e6 + 0.25, 1e8, 1e10, 1e12, 1e13, 3e14 + 0.5, 1e15}) {
    for (std::size_t i = 0; i < all.size(); i += 7) {
      const std::uint64_t word = all[i];
      const double n = draw(mean, word);
      const bool low = word < 0x8000000000000000U;
      const double u = (static_cast<double>(low ? word : ~word) + 0.5) * 0x1p-64;
      ASSERT_EQ(n, std::floor(n));
      ASSERT_TRUE(low ? u < poisson_cdf(n, mean) : u > poisson_survival(n, mean)) << mean << ' ' << word << ' ' << n;
      if (n == 0.0) continue;
      ASSERT_FALSE(low ? u < poisson_cdf(n - 1.0, mean) : u > poisson_survival(n - 1.0, mean)) << mean << ' ' << word;
    }
  }
}

TEST(PoissonQuantile, IsMonotoneInTheUniform) {
  for (const double mean : {0.01, 1.0, 9.5, 10.0, 40.0, 1300.0, 2e4, 1e9, 1e15}) {
    std::vector<std::uint64_t> sorted = words();
    // Close neighbours too, where a step of the distribution may lie between two words.
    for (std::uint64_t i = 0; i < 3000; ++i) sorted.push_back(0x6000000000000000U + (i << 33U));
    for (std::uint64_t i = 0; i < 3000; ++i) sorted.push_back(0x8000000000000000U - 1500U + i);
    std::sort(sorted.begin(), sorted.end());
    double last = 0.0;
    for (const std::uint64_t word : sorted) {
      const double n = draw(mean, word);
      ASSERT_GE(n, last) << mean << ' ' << word;
      last = n;
    }
  }
}

TEST(PoissonQuantile, IsMonotoneAcrossEveryStep) {
  // Bisects to the two neighbouring words between which the count changes: the change must be one step upwards, and the
  // fast and the exact path must put it at the same word.
  for (const double mean : {0.7, 9.0, 10.0, 25.0, 1300.0, 15000.0}) {
    const double top = mean + 4.0 * std::sqrt(mean);
    for (double n = std::max(0.0, std::floor(mean - 3.0 * std::sqrt(mean))); n < top;
         n += std::max(1.0, std::floor(mean / 300.0))) {
      std::uint64_t below = 0;
      std::uint64_t above = std::numeric_limits<std::uint64_t>::max();
      while (above - below > 1U) {
        const std::uint64_t middle = below + (above - below) / 2U;
        (draw(mean, middle) > n ? above : below) = middle;
      }
      for (std::uint64_t i = 0; i < 8; ++i) {
        ASSERT_LE(draw(mean, below - i), n);
        ASSERT_EQ(draw(mean, below - i), poisson_quantile(mean, below - i));
        ASSERT_EQ(draw(mean, above + i), n + 1.0);
        ASSERT_EQ(draw(mean, above + i), poisson_quantile(mean, above + i));
      }
    }
  }
}

TEST(PoissonQuantile, IsMonotoneInTheMean) {
  constexpr double kSteps[] = {1.0 + 1e-12, 1.0 + 1e-6, 1.0 + 1e-3};
  const std::vector<std::uint64_t> all = words();
  for (const double mean : {0.01, 1.0, 9.99999, 10.0, 40.0, 1300.0, 9999.9999, 2e4, 1e9})
    for (const double step : kSteps)
      for (std::size_t i = 0; i < all.size(); i += 11)
        ASSERT_LE(draw(mean, all[i]), draw(mean * step, all[i])) << mean << ' ' << step << ' ' << all[i];
}

/// The normal quantile of a tail probability in 80-bit arithmetic.
double normal_quantile_of(const test::PoissonOracle& oracle, double n) {
  const bool low = oracle.lower(n) < 0.5L;
  const long double tail = low ? oracle.lower(n) : oracle.upper(n);
  long double x = 0.0L;
  for (int i = 0; i < 200; ++i) {  // Newton steps on the logarithm of the tail
    const long double value = std::erfc(x / std::sqrt(2.0L)) / 2.0L;
    const long double density = std::exp(-x * x / 2.0L) / std::sqrt(2.0L * 3.14159265358979323846L);
    const long double step = (std::log(value) - std::log(tail)) * value / density;
    x += step;
    if (std::fabs(step) < 1e-17L) break;
  }
  return static_cast<double>(low ? -x : x);
}

TEST(PoissonQuantile, ApproximationStaysWithinItsBound) {
  // At u = P(X <= n) the continuous quantile is exactly n + 1. Half of the bound of poisson_quantile.hpp must do.
  double worst = 0.0;
  double worst_mean = 0.0;
  std::vector<double> means;
  for (double mean = poisson::kSmallMean; mean < 2e6; mean *= mean < 100.0 ? 1.037 : 1.9) means.push_back(mean);
  for (const double mean : means) {
    const test::PoissonOracle oracle(mean);
    const double root = std::sqrt(mean);
    const double step = std::max(1.0, std::floor(root / 50.0));
    for (double n = oracle.first(); n < oracle.last(); n += step) {
      if (std::min(oracle.lower(n), oracle.upper(n)) < 0x1p-34L) continue;  // beyond a 32-bit word
      const double w = normal_quantile_of(oracle, n);
      if (!(w / root > poisson::kLowestS && w / root < poisson::kHighestS)) continue;
      const double whole = std::floor(mean);
      const double offset = poisson::continuous_offset(mean - whole, w, root, 1.0 / mean);
      const double bound =
          poisson::kErrorFloor + poisson::kErrorPerMean / mean + poisson::kErrorOfRounding * std::fabs(offset);
      const double used = std::fabs(offset - (n + 1.0 - whole)) / bound;
      if (used > worst) worst = used, worst_mean = mean;
    }
  }
  EXPECT_LT(worst, 0.5) << "at mean " << worst_mean;
  RecordProperty("worst share of the bound", std::to_string(worst));
}

TEST(PoissonQuantile, SeldomNeedsTheLowWord) {
  const auto share = [](double mean) {
    int undecided = 0;
    constexpr std::uint32_t kStride = 42949;  // 1e5 words
    for (std::uint32_t high = 0; high < 0xffffffffU - kStride; high += kStride)
      undecided += detail::poisson_quantile_of_high_word(mean, high) < 0.0 ? 1 : 0;
    return undecided / 1e5;
  };
  EXPECT_LT(share(0.1), 1e-4);
  EXPECT_LT(share(11.0), 2e-2);
  EXPECT_LT(share(1e3), 2e-4);
  EXPECT_LT(share(1e6), 3e-4);
  EXPECT_LT(share(1e10), 3e-3);
  EXPECT_LT(share(1e15), 3e-1);
}

}  // namespace
}  // namespace astroid
