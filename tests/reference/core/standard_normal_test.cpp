#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "astroid/core/distributions.hpp"
#include "csv_rows.hpp"

namespace astroid {
namespace {

TEST(StandardNormal, MatchesTheQuantilesOfMpmath) {
  constexpr long double kTolerance = 2e-15L;  // as stated in distributions.hpp
  long double worst = 0.0L;
  int compared = 0;
  for (const auto& row : test::csv_rows("normal_quantiles.csv")) {
    const std::uint64_t word = std::stoull(row[1]);
    const long double expected = std::stold(row[2]);
    const bool short_word = row[0] == "32";
    const double value = short_word ? standard_normal(static_cast<std::uint32_t>(word)) : standard_normal(word);
    const double mirror = short_word ? standard_normal(~static_cast<std::uint32_t>(word)) : standard_normal(~word);
    const long double error = std::fabs(static_cast<long double>(value) / expected - 1.0L);
    EXPECT_LE(error, kTolerance) << row[0] << " bits, word " << word;
    // ~word is 1 - u exactly, but with 64 bits the double nearest to it may be another one
    if (short_word) {
      EXPECT_EQ(mirror, -value) << word;
    }
    EXPECT_NEAR(mirror / value, -1.0, 2e-15) << word;
    worst = std::max(worst, error);
    ++compared;
  }
  EXPECT_GT(compared, 200);
  RecordProperty("worst relative error", std::to_string(static_cast<double>(worst) * 1e15) + "e-15");
}

TEST(StandardNormal, IncreasesStrictlyWithTheWord) {
  // Every boundary of the approximation, the ends, and a stride through all words.
  constexpr std::uint32_t kSplit = 322122547;  // 0.075 * 2^32: where the central fraction ends
  for (const std::uint32_t centre : {1000U, kSplit, 0x80000000U, ~kSplit, ~1000U})
    for (std::uint32_t word = centre - 1000U; word < centre + 1000U; ++word)
      ASSERT_LT(standard_normal(word), standard_normal(word + 1U)) << word;
  constexpr std::uint32_t kStride = 7919;
  for (std::uint32_t word = 0; word < 0xffffffffU - kStride; word += kStride)
    ASSERT_LT(standard_normal(word), standard_normal(word + 1U)) << word;
}

TEST(StandardNormal, OfALongWordContinuesThatOfItsHighHalf) {
  constexpr std::uint32_t kStride = 65521;
  for (std::uint32_t high = 0; high < 0xffffffffU - kStride; high += kStride) {
    const std::uint64_t first = std::uint64_t{high} << 32U;
    ASSERT_LE(standard_normal(first), standard_normal(high)) << high;
    ASSERT_GE(standard_normal(first + 0xffffffffU), standard_normal(high)) << high;
  }
}

}  // namespace
}  // namespace astroid
