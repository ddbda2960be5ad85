#include "bessel.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid::detail {

namespace {

constexpr double kSeriesEnd = 5.0;       // beyond, alternating terms cancel digits
constexpr double kRecurrenceEnd = 17.0;  // beyond, the asymptotic expansion's least term, e^(-2x), is below rounding

// J1(x) / x.
double series(double x) {
  const double q = -0.25 * x * x;
  double term = 0.5;
  double sum = term;
  constexpr double kLast = 1e-18;
  for (int k = 1; std::abs(term) > kLast; ++k) {
    term *= q / (static_cast<double>(k) * (k + 1.0));
    sum += term;
  }
  return sum;
}

double recurrence(double x) {
  constexpr int kStart = 60;  // even; J60(17) is 1e-26 of the largest
  const double two_over_x = 2.0 / x;
  double above = 0.0;
  double here = 1e-250;
  double sum = 0.0;  // J0 + 2 (J2 + J4 + ...), which is 1
  double j1 = 0.0;
  for (int n = kStart; n > 0; --n) {
    if (n % 2 == 0) sum += 2.0 * here;
    if (n == 1) j1 = here;
    const double below = two_over_x * n * here - above;
    above = here;
    here = below;
  }
  sum += here;
  return j1 / sum;
}

// a_k of J1's asymptotic expansion with its signs, + + - - ...: a_k = a_(k-1) (4 - (2k - 1)²) / (8 k).
constexpr int kAsymptoticTerms = 30;
constexpr std::array<double, kAsymptoticTerms> asymptotic_coefficients() {
  std::array<double, kAsymptoticTerms> a{1.0};
  double size = 1.0;
  for (int k = 1; k < kAsymptoticTerms; ++k) {
    const double odd = 2.0 * k - 1.0;
    size *= (4.0 - odd * odd) / (8.0 * k);
    a[static_cast<std::size_t>(k)] = (k / 2) % 2 == 0 ? size : -size;
  }
  return a;
}

double asymptotic(double x) {
  // J1 = sqrt(2 / (pi x)) (P cos w - Q sin w), w = x - 3 pi / 4; P and Q are the even and odd terms of a_k / x^k.
  static constexpr std::array<double, kAsymptoticTerms> kA = asymptotic_coefficients();
  const double per_x = 1.0 / x;
  const double per_x2 = per_x * per_x;
  double p = 0.0;
  double q = 0.0;
  for (std::size_t k = kA.size(); k > 0; k -= 2) {
    q = q * per_x2 + kA[k - 1];
    p = p * per_x2 + kA[k - 2];
  }
  const double w = x - 0.75 * kPi;
  return det::sqrt(2.0 / kPi * per_x) * (p * det::cos(w) - q * per_x * det::sin(w));
}

}  // namespace

double bessel_j1(double x) {
  const double size = std::abs(x);
  const double value = size < kSeriesEnd       ? size * series(size)
                       : size < kRecurrenceEnd ? recurrence(size)
                                               : asymptotic(size);
  return x < 0.0 ? -value : value;
}

double jinc(double x) {
  const double size = std::abs(x);
  return size < kSeriesEnd ? 2.0 * series(size) : 2.0 * bessel_j1(size) / size;
}

}  // namespace astroid::detail
