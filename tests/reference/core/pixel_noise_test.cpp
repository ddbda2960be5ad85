// The single-precision draws of pixels against exact quantiles.
#include "astroid/core/pixel_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "poisson_oracle.hpp"
#include "poisson_quantile.hpp"
#include "vector/pixel_noise_fits.hpp"
#include "vector/pixel_noise_reference.hpp"

namespace astroid {
namespace {

/// Both ends, the middle, and a regular sample of the rest.
std::vector<std::uint32_t> words() {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    all.push_back(i);
    all.push_back(~i);
    all.push_back(0x80000000U + i);
    all.push_back(0x7fffffffU - i);
  }
  constexpr std::uint32_t kStride = 1021;
  for (std::uint64_t word = 0; word <= 0xffffffffU; word += kStride) all.push_back(static_cast<std::uint32_t>(word));
  return all;
}

TEST(PixelNormal, IsTheQuantileOfItsWord) {
  double worst = 0.0;
  double worst_probability = 0.0;
  for (const std::uint32_t word : words()) {
    const double exact = standard_normal(word);
    const double error = std::fabs(static_cast<double>(reference::pixel_normal(word)) - exact);
    ASSERT_LE(error, 1e-7 + 8e-7 * std::fabs(exact)) << word;
    worst = std::max(worst, error / (1e-7 + 8e-7 * std::fabs(exact)));
    worst_probability =
        std::max(worst_probability, error * std::exp(-0.5 * exact * exact) / std::sqrt(2.0 * 3.14159265));
  }
  EXPECT_LT(worst_probability, 3e-7);
  RecordProperty("worst share of the bound", std::to_string(worst));
}

TEST(PixelNormal, IsOddAndGrowsWithItsWord) {
  std::vector<std::uint32_t> sorted = words();
  std::ranges::sort(sorted);
  float last = -std::numeric_limits<float>::infinity();
  for (const std::uint32_t word : sorted) {
    const float z = reference::pixel_normal(word);
    ASSERT_EQ(z, -reference::pixel_normal(~word)) << word;
    // Rounding may undo a step between neighbouring words.
    ASSERT_GE(z, last - 6e-7F * std::fabs(z) - 2e-7F) << word;
    last = std::max(last, z);
  }
}

TEST(PixelPoisson, ApproximationStaysWithinItsBound) {
  // Where the single-precision path decides, it must agree with the exact quantile for every low word, and close to the
  // steps of the distribution it must not decide: both sides of every step are looked at as closely as words allow.
  for (const double mean : {10.0, 10.7, 12.0, 15.5, 20.0, 33.3, 60.0, 99.5, 255.0, 945.0, 3000.0, 20000.5, 1e6}) {
    const double root = std::sqrt(mean);
    const double step = std::max(1.0, std::floor(root / 40.0));
    const test::PoissonOracle oracle(mean);
    int decided = 0;
    int all = 0;
    for (double n = oracle.first(); n < oracle.last(); n += step) {
      const long double edge = oracle.lower(n) * 4294967296.0L;  // in words
      if (!(edge > 64.0L && edge < 4294967232.0L)) continue;
      for (std::int64_t distance = 1; distance < std::int64_t{1} << 28; distance *= 2)
        for (const std::int64_t sign : {-1, 1}) {
          const auto at = static_cast<std::int64_t>(edge) + sign * distance;
          if (at < 0 || at > 0xffffffffLL) continue;
          const auto word = static_cast<std::uint32_t>(at);
          const double count = reference::poisson_of_word(mean, word);
          ++all;
          if (count < 0.0) continue;
          ++decided;
          ASSERT_EQ(count, poisson_quantile(mean, std::uint64_t{word} << 32U)) << mean << ' ' << word;
          ASSERT_EQ(count, poisson_quantile(mean, std::uint64_t{word} << 32U | 0xffffffffU)) << mean << ' ' << word;
        }
    }
    ASSERT_GT(decided, all / 10) << mean;
  }
}

/// Largest error of the continuous quantile, as a share of the bound, over the steps of the distribution: at u = P(X <=
/// n) it is exactly n + 1.
TEST(PixelPoisson, LeavesAFactorOfTwoInItsBound) {
  double worst = 0.0;
  for (double mean = 10.0; mean < 2e6; mean *= mean < 100.0 ? 1.037 : 1.9) {
    const test::PoissonOracle oracle(mean);
    const double root = std::sqrt(mean);
    const double step = std::max(1.0, std::floor(root / 50.0));
    for (double n = oracle.first(); n < oracle.last(); n += step) {
      const long double edge = oracle.lower(n) * 4294967296.0L - 0.5L;
      if (!(edge > 1e5L && edge < 4.2948e9L)) continue;
      const auto word = static_cast<std::uint32_t>(std::llround(edge));
      const reference::ContinuousCount x = reference::continuous_count(mean, word);
      if (!x.in_range) continue;
      // The word is up to half a step off: that much of x is not an error of the approximation.
      const double w = standard_normal(word);
      const double density = std::exp(-0.5 * w * w) / std::sqrt(2.0 * 3.14159265358979);
      const double slack = 1.4 * root * 0.5 * 0x1p-32 / density;
      const double error = std::fabs(static_cast<double>(x.offset) - (n + 0.5 - std::floor(mean))) - slack;
      worst = std::max(worst, error / (0.5 - static_cast<double>(x.room)));
    }
  }
  EXPECT_LT(worst, 0.5);
  EXPECT_GT(worst, 0.0);
  RecordProperty("worst share of the bound", std::to_string(worst));
}

TEST(PixelPoisson, SeldomNeedsMoreThanSinglePrecision) {
  const auto share = [](double mean) {
    int undecided = 0;
    constexpr std::uint32_t kStride = 42949;  // 1e5 words
    for (std::uint32_t word = 0; word < 0xffffffffU - kStride; word += kStride)
      undecided += reference::poisson_of_word(mean, word) < 0.0 ? 1 : 0;
    return undecided / 1e5;
  };
  EXPECT_LT(share(0.1), 1e-3);
  EXPECT_LT(share(5.0), 1e-3);
  EXPECT_LT(share(11.0), 2e-2);
  EXPECT_LT(share(60.0), 2e-3);
  EXPECT_LT(share(1e4), 2e-3);
  EXPECT_LT(share(1e6), 5e-3);
}

}  // namespace
}  // namespace astroid
