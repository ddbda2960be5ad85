// The Poisson distribution function where accuracy counts more than speed.
#pragma once

namespace astroid::poisson {

/// Means below this are summed from n = 0; above, expansions in 1/mean serve.
inline constexpr double kSmallMean = 10.0;

/// P(X <= n) and P(X > n). The shorter of both is computed, the other is one minus it, so they agree to the last bit.
struct Tails {
  double lower = 0.0;
  double upper = 0.0;
};

/// @param n an integer >= 0. @param mean 0 .. kLargestPoissonMean, not checked. @accuracy as poisson_cdf.
Tails tails(double n, double mean);

}  // namespace astroid::poisson
