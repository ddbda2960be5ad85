#include "poisson_quantile.hpp"

#include <fmt/format.h>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace poisson {

void check_mean(double mean) {
  if (!(mean >= 0.0 && mean <= kLargestPoissonMean))
    throw BugError(fmt::format("a Poisson mean of {} is outside 0 .. {}", mean, kLargestPoissonMean));
}

namespace {

/// Whether u < P(X <= n), u = (word + 1/2) / 2^64, compared on the side of the shorter tail of u.
bool covers(double n, double mean, std::uint64_t word) {
  constexpr std::uint64_t kHalf = 0x8000000000000000U;
  constexpr double kStep = 0x1p-64;
  const Tails tail = tails(n, mean);
  if (word < kHalf) return (static_cast<double>(word) + 0.5) * kStep < tail.lower;
  return (static_cast<double>(~word) + 0.5) * kStep > tail.upper;
}

/// A count near the quantile: any guess leads to the same result, a good one faster.
double guess(double mean, std::uint64_t word) {
  const double w = normal::quantile(word);
  const double root = det::sqrt(mean);
  if (mean >= kSmallMean && w > kLowestS * root && w < kHighestS * root) {
    const double whole = std::floor(mean);
    return whole + std::floor(continuous_offset(mean - whole, w, root, 1.0 / mean));
  }
  // Cornish-Fisher: the powers of s up to the third in f, to the second in c0.
  constexpr double kF3 = -1.0 / 72.0;
  constexpr double kC01 = -1.0 / 36.0;
  const double correction = root > 1.0 ? w * (kC01 + kF3 * w * w) / root : 0.0;
  return std::max(0.0, std::floor(mean + root * w + (2.0 + w * w) / 6.0 + correction));
}

}  // namespace
}  // namespace poisson

double poisson_cdf(double n, double mean) {
  poisson::check_mean(mean);
  ASTROID_CHECK_EQ(n, std::floor(n));
  ASTROID_CHECK_LE(0.0, n);
  return poisson::tails(n, mean).lower;
}

double poisson_survival(double n, double mean) {
  poisson::check_mean(mean);
  ASTROID_CHECK_EQ(n, std::floor(n));
  ASTROID_CHECK_LE(0.0, n);
  return poisson::tails(n, mean).upper;
}

double poisson_quantile(double mean, std::uint64_t word) {
  poisson::check_mean(mean);
  if (mean == 0.0) return 0.0;
  double n = poisson::guess(mean, word);
  while (n > 0.0 && poisson::covers(n - 1.0, mean, word)) --n;
  while (!poisson::covers(n, mean, word)) ++n;
  return n;
}

double detail::poisson_quantile_of_high_word(double mean, std::uint32_t high) {
  poisson::check_mean(mean);
  return poisson::quantile_of_high_word(mean, high);
}

}  // namespace astroid
