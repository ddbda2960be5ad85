// The standard normal quantile as straight arithmetic, inlined into the loops over pixels.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "polynomial.hpp"

namespace astroid::normal {

/// Natural logarithm of a normal positive double: mantissa in [sqrt(1/2), sqrt(2)), atanh series to s^19.
/// @accuracy absolute 2e-16 plus relative 2e-16.
inline double log_of_positive(double value) {
  constexpr std::uint64_t kSqrtHalfBits = 0x3fe6a09e667f3bcdU;  // bits of the double sqrt(1/2)
  constexpr std::uint64_t kMantissaMask = 0x000fffffffffffffU;
  constexpr unsigned kMantissaBits = 52;
  constexpr double kLn2 = 0.693147180559945309417;
  constexpr double kAtanh[] = {2.0,        2.0 / 3.0,  2.0 / 5.0,  2.0 / 7.0,  2.0 / 9.0,
                               2.0 / 11.0, 2.0 / 13.0, 2.0 / 15.0, 2.0 / 17.0, 2.0 / 19.0};
  const std::uint64_t shifted = std::bit_cast<std::uint64_t>(value) - kSqrtHalfBits;
  const auto exponent =
      static_cast<double>(static_cast<std::int32_t>(static_cast<std::int64_t>(shifted) >> kMantissaBits));
  const double mantissa = std::bit_cast<double>((shifted & kMantissaMask) + kSqrtHalfBits);
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  return exponent * kLn2 + s * polynomial(s * s, kAtanh);
}

// Coefficients of PPND16, Wichura 1988 (algorithm AS 241), lowest power first. Names as in the paper.
inline constexpr double kA[] = {3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                                1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                                3.3430575583588128105e+4, 2.5090809287301226727e+3};
inline constexpr double kB[] = {1.0,
                                4.2313330701600911252e+1,
                                6.8718700749205790830e+2,
                                5.3941960214247511077e+3,
                                2.1213794301586595867e+4,
                                3.9307895800092710610e+4,
                                2.8729085735721942674e+4,
                                5.2264952788528545610e+3};
inline constexpr double kC[] = {1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                2.27238449892691845833e-2, 7.74545014278341407640e-4};
inline constexpr double kD[] = {1.0,
                                2.05319162663775882187e0,
                                1.67638483018380384940e0,
                                6.89767334985100004550e-1,
                                1.48103976427480074590e-1,
                                1.51986665636164571966e-2,
                                5.47593808499534494600e-4,
                                1.05075007164441684324e-9};
inline constexpr double kE[] = {6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                                2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                2.71155556874348757815e-5, 2.01033439929228813265e-7};
inline constexpr double kF[] = {1.0,
                                5.99832206555887937690e-1,
                                1.36929880922735805310e-1,
                                1.48753612908506148525e-2,
                                7.86869131145613259100e-4,
                                1.84631831751005468180e-5,
                                1.42151175831644588870e-7,
                                2.04426310338993978564e-15};
inline constexpr double kCentralHalfWidth = 0.425;
inline constexpr double kCentralConstant = 0.180625;  // kCentralHalfWidth^2
inline constexpr double kTailShift = 1.6;
inline constexpr double kFarTail = 5.0;

/// |q| <= 0.425, q = probability - 1/2.
inline double central(double q) {
  const double r = kCentralConstant - q * q;
  return q * (polynomial(r, kA) / polynomial(r, kB));
}

/// Magnitude of the quantile where sqrt(-ln tail) = r <= 5.
inline double near_tail(double r) {
  return polynomial(r - kTailShift, kC) / polynomial(r - kTailShift, kD);
}
inline double far_tail(double r) {
  return polynomial(r - kFarTail, kE) / polynomial(r - kFarTail, kF);
}

/// Probability of the word minus 1/2: exact, odd under word -> ~word.
inline double centred(std::uint32_t word) {
  constexpr std::uint32_t kSign = 0x80000000U;
  constexpr double kStep = 0x1p-32;
  return (static_cast<double>(static_cast<std::int32_t>(word ^ kSign)) + 0.5) * kStep;
}

/// Quantile for |q| > 0.425 of a 32-bit word. The tail is at least 2^-33 = e^-22.9, so sqrt(-ln tail) stays below 5.
inline double tail(double q) {
  const double r = std::sqrt(-log_of_positive(0.5 - std::fabs(q)));  // the difference is exact
  return std::copysign(near_tail(r), q);
}

inline double quantile(std::uint32_t word) {
  const double q = centred(word);
  return std::fabs(q) <= kCentralHalfWidth ? central(q) : tail(q);
}

inline double quantile(std::uint64_t word) {
  constexpr std::uint64_t kSign = 0x8000000000000000U;
  constexpr double kStep = 0x1p-64;
  const double q = (static_cast<double>(static_cast<std::int64_t>(word ^ kSign)) + 0.5) * kStep;
  if (std::fabs(q) <= kCentralHalfWidth) return central(q);
  const std::uint64_t below = (word & kSign) != 0U ? ~word : word;
  const double r = std::sqrt(-log_of_positive((static_cast<double>(below) + 0.5) * kStep));
  return std::copysign(r <= kFarTail ? near_tail(r) : far_tail(r), q);
}

}  // namespace astroid::normal
