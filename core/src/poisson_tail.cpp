#include "poisson_tail.hpp"

#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"
#include "polynomial.hpp"

namespace astroid::poisson {

namespace {

constexpr double kNegligible = 1e-18;  // of a sum of positive terms; well below the rounding of a double

/// n ln(n / mean) + mean - n, both positive, without cancellation. @source Loader2000, there called bd0.
double deviance(double n, double mean) {
  constexpr double kSeriesLimit = 0.5;
  const double v = (n - mean) / (n + mean);
  if (std::fabs(v) > kSeriesLimit) return n * det::log(n / mean) + (mean - n);
  double sum = 0.0;
  double power = 2.0 * n * v;
  for (double odd = 3.0;; odd += 2.0) {
    power *= v * v;
    const double next = sum + power / odd;
    if (next == sum) return (n - mean) * v + sum;
    sum = next;
  }
}

/// ln n! minus Stirling's formula, n >= 16. @accuracy 1e-17. @source Loader2000, there called stirlerr.
double stirling_error(double n) {
  constexpr double kBernoulli[] = {1.0 / 12.0,    -1.0 / 360.0, 1.0 / 1260.0,
                                   -1.0 / 1680.0, 1.0 / 1188.0, -691.0 / 360360.0};
  return polynomial(1.0 / (n * n), kBernoulli) / n;
}

/// P(X = n). The product serves small means and small counts, where nothing cancels; Loader's form the rest.
double probability(double n, double mean) {
  constexpr double kSmallCount = 16.0;
  if (mean < kSmallMean || n < kSmallCount) {
    double p = det::exp(-mean);
    for (double k = 1.0; k <= n && p > 0.0; ++k) p *= mean / k;
    return p;
  }
  return det::exp(-deviance(n, mean) - stirling_error(n)) / det::sqrt(2.0 * kPi * n);
}

/// P(X <= n) for n + 1 <= mean: terms fall from n downwards.
double sum_below(double n, double mean) {
  double term = 1.0;
  double sum = 1.0;
  for (double k = n; k >= 1.0 && term > kNegligible * sum; --k) {
    term *= k / mean;
    sum += term;
  }
  return probability(n, mean) * sum;
}

/// P(X > n) for n + 1 > mean: terms fall from n + 1 upwards.
double sum_above(double n, double mean) {
  double term = 1.0;
  double sum = 1.0;
  for (double k = n + 2.0; term > kNegligible * sum; ++k) {
    term *= mean / k;
    sum += term;
  }
  return probability(n + 1.0, mean) * sum;
}

// Taylor coefficients in eta of Temme's C_0 .. C_3 (DLMF 8.12.10), from the recurrence C_k = C_{k-1}'/eta + (-1)^k
// g_k/mu in exact fractions. Enough of them for |eta| < 0.3 and a > 1e4: what is left out is below 1e-18.
constexpr double kC0[] = {
    -0.333333333333333333,   0.0833333333333333333,    -0.0148148148148148148,   0.00115740740740740741,
    0.0003527336860670194,   -0.000178755144032921811, 0.0000391926317852243778, -2.18544851067999216e-6,
    -1.85406221071515996e-6, 8.29671134095308601e-7,   -1.76659527368260793e-7,  6.70785354340149858e-9,
    1.0261809784240308e-8,   -4.38203601845335319e-9,  9.14769958223679023e-10,  -2.55141939949462498e-11};
constexpr double kC1[] = {-0.00185185185185185185,   -0.00347222222222222222, 0.0026455026455026455,
                          -0.000990226337448559671,  0.000205761316872427984, -4.01877572016460905e-7,
                          -0.0000180985503344899778, 7.64916091608111008e-6,  -1.6120900894563446e-6,
                          4.64712780280743434e-9,    1.37863344691572096e-7,  -5.75254560351770496e-8};
constexpr double kC2[] = {0.0041335978835978836,     -0.00268132716049382716,  0.000771604938271604938,
                          2.00938786008230453e-6,    -0.000107366532263651605, 0.0000529234488291201254,
                          -0.0000127606351886187277, 3.42357873409613807e-8,   1.37219573090629332e-6};
constexpr double kC3[] = {0.000649434156378600823, 0.000229472093621399177, -0.000469189494395255712,
                          0.000267720632062838853, -0.0000756180167188397641};
constexpr double kUniformMean = 1e4;  // from here on
constexpr double kUniformEta = 0.3;   // up to here

/// The shorter tail from the uniform expansion of the incomplete gamma functions Q(a, mean), P(a, mean), a = n + 1:
/// erfc(sqrt(D))/2 -+ ..., D = a eta^2 / 2 the deviance. @source Temme1979.
double uniform_expansion(double a, double deviance_of_a, double eta, bool lower) {
  const double series =
      polynomial(eta, kC0) + (polynomial(eta, kC1) + (polynomial(eta, kC2) + polynomial(eta, kC3) / a) / a) / a;
  const double remainder = det::exp(-deviance_of_a) / det::sqrt(2.0 * kPi * a) * series;
  const double leading = 0.5 * det::erfc(det::sqrt(deviance_of_a));
  return lower ? leading + remainder : leading - remainder;
}

}  // namespace

Tails tails(double n, double mean) {
  const double a = n + 1.0;
  const bool lower = a <= mean;
  double shorter = 0.0;
  bool expanded = false;
  if (mean > kUniformMean) {
    const double d = deviance(a, mean);
    const double eta = std::copysign(det::sqrt(2.0 * d / a), mean - a);
    if (std::fabs(eta) < kUniformEta) {
      shorter = uniform_expansion(a, d, eta, lower);
      expanded = true;
    }
  }
  if (!expanded) shorter = lower ? sum_below(n, mean) : sum_above(n, mean);
  return lower ? Tails{shorter, 1.0 - shorter} : Tails{1.0 - shorter, shorter};
}

}  // namespace astroid::poisson
