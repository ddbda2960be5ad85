// Random numbers of a distribution, each a monotone function of one uniform at an address (docs/random-numbers.md).
//
// Monotone inversion keeps runs coupled: with the same address, a pixel that is slightly brighter draws the same or
// slightly more electrons. Everything uses only + - * / sqrt and astroid/core/math.hpp: the same bits on every
// x86-64-v2 processor. @thread safe, no state, no allocation.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "astroid/core/random.hpp"

namespace astroid {

// ---- Functions of random words ----

/// (word + 1/2) / 2^32: exact, in (0, 1), never 0 or 1.
constexpr double uniform_from(std::uint32_t word) {
  return (static_cast<double>(word) + 0.5) * 0x1p-32;
}
/// (word >> 12 + 1/2) / 2^52: exact, in (0, 1), never 0 or 1.
constexpr double uniform_from(std::uint64_t word) {
  constexpr unsigned kDropped = 12;  // with the half, the remaining 52 bits fill a double exactly
  return (static_cast<double>(word >> kDropped) + 0.5) * 0x1p-52;
}

/// Standard normal quantile of (word + 1/2) / 2^32: from -6.34 to 6.34, strictly increasing in the word, odd under
/// word -> ~word. @accuracy relative 2e-15 (test: StandardNormal.MatchesTheQuantilesOfMpmath).
/// @source Wichura1988, algorithm PPND16.
double standard_normal(std::uint32_t word);
/// The same of (word + 1/2) / 2^64: from -9.16 to 9.16, increasing but for rounding in the last place.
double standard_normal(std::uint64_t word);

/// Largest mean of a Poisson draw: above it doubles no longer hold every integer a draw can return, with margin.
inline constexpr double kLargestPoissonMean = 1e15;

/// P(X <= n) of a Poisson distribution. @param n  an integer >= 0. @param mean  0 .. 1e15.
/// @accuracy relative 3e-14 where the result is above 1e-250 (test: PoissonTails.MatchMpmath).
/// @throws BugError outside those ranges. @source Loader2000 (probabilities), Temme1979 (mean above 1e4).
double poisson_cdf(double n, double mean);
/// P(X > n), without cancellation; the rest as poisson_cdf.
double poisson_survival(double n, double mean);

/// Poisson quantile of the 64-bit uniform u = (word + 1/2) / 2^64: the smallest n with u < P(X <= n), an exact
/// integer in a double. Exactly monotone in the word, for every mean 0 .. 1e15.
/// @accuracy the distribution function is that of poisson_cdf, sampled in steps of 2^-64.
/// @throws BugError when the mean is negative, NaN or above 1e15 (callers guard the user's numbers).
double poisson_quantile(double mean, std::uint64_t word);

namespace detail {
/// The quantile if the high word alone decides it, otherwise a negative number.
double poisson_quantile_of_high_word(double mean, std::uint32_t high);
}  // namespace detail

/// poisson_quantile of the word high * 2^32 + low(), where low() is called only when the high word leaves the value
/// open: in 2e-5 of draws of mean 1e3, 1e-3 of mean 1e10, 13 % of mean 1e15. @source Giles2016 for
/// the fast path, an expansion in 1/mean.
template <class LowWord>
requires std::is_invocable_r_v<std::uint32_t, LowWord>
double poisson_quantile(double mean, std::uint32_t high, LowWord&& low) {
  constexpr unsigned kWordBits = std::numeric_limits<std::uint32_t>::digits;
  const double count = detail::poisson_quantile_of_high_word(mean, high);
  if (count >= 0.0) return count;
  return poisson_quantile(mean, std::uint64_t{high} << kWordBits | std::forward<LowWord>(low)());
}

// ---- Draws at addresses ----

/// Pixels x0, x0 + 1, ... of row y in one exposure and read. Effects of scope `static` use exposure 0.
struct PixelAddress {
  std::int32_t x0 = 0;  ///< detector column of the first pixel; may be negative
  std::int32_t y = 0;   ///< detector row; may be negative
  std::uint32_t exposure = 0;
  std::uint16_t read = 0;
  std::uint16_t draw = 0;  ///< which random number of the pixel within the effect
};

/// Uniforms in (0, 1), 32 bits. A pixel's value does not depend on x0: any window gives the same.
void uniform_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out);
/// Standard normals in double precision, one after the other: the oracle of pixel_normals() (pixel_noise.hpp).
void normal_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out);
/// Poisson counts of the given means. Uses the words of `draw` and, where those leave the count open, `draw + 1`.
/// @throws BugError when a mean is negative, NaN or above 1e15, when the spans differ in size or draw is 65535.
void poisson_row(const RandomStream& stream, const PixelAddress& address, std::span<const double> mean,
                 std::span<double> out);

/// A star, by the hash of its identifier, in one exposure.
struct SourceAddress {
  std::uint64_t hash = 0;
  std::uint32_t exposure = 0;
  std::uint16_t read = 0;
  std::uint16_t draw = 0;
};
double uniform_for_source(const RandomStream& stream, const SourceAddress& address);
double normal_for_source(const RandomStream& stream, const SourceAddress& address);
double poisson_for_source(const RandomStream& stream, const SourceAddress& address, double mean);

/// One step of a sequence (attitude, cosmic hits), so a longer run has the shorter one as its beginning.
struct StepAddress {
  std::uint64_t step = 0;
  std::uint32_t axis = 0;
  std::uint32_t draw = 0;
};
double uniform_at_step(const RandomStream& stream, const StepAddress& address);
double normal_at_step(const RandomStream& stream, const StepAddress& address);
double poisson_at_step(const RandomStream& stream, const StepAddress& address, double mean);

}  // namespace astroid
