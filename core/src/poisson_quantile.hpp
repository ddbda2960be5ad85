// The Poisson quantile of one random word, inlined into the loops over pixels; see poisson_quantile.cpp for the rest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "astroid/core/distributions.hpp"
#include "astroid/core/math.hpp"
#include "inline_exponential.hpp"
#include "normal_quantile.hpp"
#include "poisson_tail.hpp"
#include "polynomial.hpp"

namespace astroid::poisson {

/// Where the count cannot be told from the high word alone.
inline constexpr double kUndecided = -1.0;

// The continuous quantile x, which solves Q(x, mean) = Phi(w), is mean f(s) + c0(s) + c1(s)/mean + c2(s)/mean^2 + ...,
// s = w/sqrt(mean), f ln f - f + 1 = s^2/2 (Giles 2016, section 2; c1 and c2 by the same matching of powers). The count
// is floor(x). f = 1 + s + s^2 A(s). Chebyshev fits of A, c0, c1, c2 in kLowestS .. kHighestS, errors 4e-8, 3e-6, 3e-4,
// 5e-3.
inline constexpr double kLowestS = -0.75;
inline constexpr double kHighestS = 1.0;
inline constexpr double kA[] = {0.16666664613246387,    -0.01388881564595661,   0.0037047654764892134,
                                -0.0013329018854921388, 0.00055039987823315853, -0.00024516993406746291,
                                0.00014442091664630126, -9.6723598834658615e-5, 3.259579953765696e-5};
inline constexpr double kC0[] = {0.33333461705106369,    -0.027785144226510806, 0.0086049294197186201,
                                 -0.0034245327546254027, 0.0017857288520951273, -0.001173811464520522,
                                 0.00043486959497062802};
inline constexpr double kC1[] = {-0.019656194778656175, 0.016548197823518882, -0.013773599024095456,
                                 0.013438593330746332, -0.0065591577357376944};
inline constexpr double kC2[] = {-0.001822513039169691, 0.0023847288185194428};

// Bound on the error of x: kErrorFloor + kErrorPerMean / mean + kErrorOfRounding |x - mean|. The test
// PoissonQuantile.ApproximationStaysWithinItsBound measures it; a factor 2 or more is left.
inline constexpr double kErrorFloor = 1e-5;
inline constexpr double kErrorPerMean = 2e-3;
inline constexpr double kErrorOfRounding = 1e-14;

/// x - floor(mean) for kLowestS < w/sqrt(mean) < kHighestS.
inline double continuous_offset(double fraction, double w, double root, double inverse) {
  const double s = w * root * inverse;
  return fraction + (root * w + (w * w * polynomial(s, kA) +
                                 (polynomial(s, kC0) + inverse * (polynomial(s, kC1) + inverse * polynomial(s, kC2)))));
}

/// The count if w, the normal quantile of the high word, decides it; else kUndecided, as for every mean that is small
/// or out of range. Without branches.
inline double quantile_of_normal(double mean, double w, std::uint32_t high) {
  const double root = det::sqrt(mean);
  const double inverse = 1.0 / mean;
  const double s = w * root * inverse;
  const double whole = std::floor(mean);
  const double offset = continuous_offset(mean - whole, w, root, inverse);
  const double steps = std::floor(offset);
  const double distance = std::min(offset - steps, steps + 1.0 - offset);
  const double bound = kErrorFloor + kErrorPerMean * inverse + kErrorOfRounding * std::fabs(offset);
  // The low word moves the uniform by up to 2^-33 either way, and x by 2^-33 (dx/dw) / phi(w). With t = tail 2^32,
  // phi(w) >= 0.79 t 2^-32 (Mills' ratio) and dx/dw < 1.33 sqrt(mean), that is less than sqrt(mean) / t for t > 6;
  // smaller t never pass, since distance <= 1/2 and mean >= 10.
  const double t = 0x1p31 - std::fabs(static_cast<double>(static_cast<std::int32_t>(high ^ 0x80000000U)) + 0.5);
  const bool decided =
      static_cast<bool>(static_cast<int>(mean >= kSmallMean) & static_cast<int>(mean <= kLargestPoissonMean) &
                        static_cast<int>(s > kLowestS) & static_cast<int>(s < kHighestS) &
                        static_cast<int>((distance - bound) * t > root));
  return decided ? whole + steps : kUndecided;
}

/// @param none  P(X = 0) = exp(-mean), from inline_exponential.
inline double quantile_of_high_word_small(double mean, double none, std::uint32_t high) {
  constexpr double kStep = 0x1p-32;
  constexpr double kMargin = 0x1p-33 + 1e-14;  // half a step of the high word, and the rounding of the sum
  const double u = (static_cast<double>(high) + 0.5) * kStep;
  double term = none;
  double sum = term;
  double n = 0.0;
  while (u >= sum + kMargin) {
    n += 1.0;
    term *= mean / n;
    sum += term;
  }
  return u > sum - kMargin ? kUndecided : n;
}

/// @param mean 0 .. kLargestPoissonMean, not checked.
inline double quantile_of_high_word(double mean, std::uint32_t high) {
  return mean >= kSmallMean ? quantile_of_normal(mean, normal::quantile(high), high)
                            : quantile_of_high_word_small(mean, inline_exponential(-mean), high);
}

/// Throws BugError unless 0 <= mean <= kLargestPoissonMean.
void check_mean(double mean);

}  // namespace astroid::poisson
