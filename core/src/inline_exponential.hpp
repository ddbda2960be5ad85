// e^x as straight arithmetic, inlined into the loops over pixels.
#pragma once

#include <bit>
#include <cstdint>

#include "polynomial.hpp"

namespace astroid {

/// e^x for -700 < x < 700: 2^k e^r, |r| <= ln(2)/2, Taylor polynomial to r^13 (the next term is below 1e-17).
/// @accuracy relative 4e-16 (test: InlineExponential.IsAccurate).
inline double inline_exponential(double x) {
  constexpr double kLog2E = 1.442695040888963407360;
  constexpr double kLn2High = 0x1.62e42fefa38p-1;  // ln 2 in 42 bits, so k ln 2 is exact
  constexpr double kLn2Low = 0x1.ef35793c7673p-45;
  constexpr double kRounder = 0x1.8p52;  // added, it leaves the nearest integer in the lowest bits
  constexpr unsigned kMantissaBits = 52;
  constexpr double kInverseFactorials[] = {1.0,
                                           1.0,
                                           1.0 / 2.0,
                                           1.0 / 6.0,
                                           1.0 / 24.0,
                                           1.0 / 120.0,
                                           1.0 / 720.0,
                                           1.0 / 5040.0,
                                           1.0 / 40320.0,
                                           1.0 / 362880.0,
                                           1.0 / 3628800.0,
                                           1.0 / 39916800.0,
                                           1.0 / 479001600.0,
                                           1.0 / 6227020800.0};
  const double shifted = x * kLog2E + kRounder;
  const double k = shifted - kRounder;
  const double r = (x - k * kLn2High) - k * kLn2Low;
  const std::uint64_t scale =
      (std::bit_cast<std::uint64_t>(shifted) << kMantissaBits) + std::bit_cast<std::uint64_t>(1.0);
  return polynomial(r, kInverseFactorials) * std::bit_cast<double>(scale);
}

}  // namespace astroid
