#include "gaussian_tail.hpp"

#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

constexpr std::size_t kLongTerms = 24;  // at spacing 1/32 the next term is below 1e-30 of the first
constexpr long double kErfcOfSix = 2.15197367124989131165933503991873846e-17L;
constexpr long double kExpOfMinusThirtySix = 2.31952283024356938831226360973808004e-16L;
constexpr long double kTwoOverRootPi = 1.12837916709551257389615890312154517L;

// Taylor coefficients at t of y = erfc, from y'' = -2 t y' and the first two, y and y'.
std::array<long double, kLongTerms> expansion(long double t, const std::array<long double, 2>& start) {
  std::array<long double, kLongTerms> c{start[0], start[1]};
  for (std::size_t n = 0; n + 2 < kLongTerms; ++n) {
    const auto k = static_cast<long double>(n);
    c[n + 2] = -2.0L * (t * (k + 1.0L) * c[n + 1] + k * c[n]) / ((k + 2.0L) * (k + 1.0L));
  }
  return c;
}

// Laplace's continued fraction exp(-t^2) / sqrt(pi) / (t + 1/2 / (t + 2/2 / (t + ...))) from its last level to its
// first as numerator and denominator, so that it takes one division. @accuracy 6e-16 + t^2 2.2e-16 relative for t >= 6
double far_tail(double t) {
  constexpr int kLevels = 12;  // leaves 5.2e-16 at t = 6 and less beyond
  constexpr double kOneOverRootPi = 0.564189583547756286948079451560772586;
  double numerator = t;
  double denominator = 1.0;
  for (int level = kLevels; level > 0; --level) {
    const double next = t * numerator + 0.5 * level * denominator;
    denominator = numerator;
    numerator = next;
  }
  return kOneOverRootPi * det::exp(-t * t) * denominator / numerator;
}

}  // namespace

// Downwards from the far end, where the step is stable: erfc grows and its relative error does not.
ErfcTable::ErfcTable() {
  long double value = kErfcOfSix;
  long double slope = -kTwoOverRootPi * kExpOfMinusThirtySix;
  const long double step = -static_cast<long double>(kSpacing);
  for (std::size_t node = kNodes; node-- > 0;) {
    const long double t = static_cast<long double>(node) * static_cast<long double>(kSpacing);
    const auto c = expansion(t, {value, slope});
    for (std::size_t n = 0; n < kTerms; ++n) nodes_[node][n] = static_cast<double>(c[n]);
    value = 0.0L;
    slope = 0.0L;
    for (std::size_t n = kLongTerms; n-- > 0;) {
      value = value * step + c[n];
      if (n > 0) slope = slope * step + static_cast<long double>(n) * c[n];
    }
  }
}

const ErfcTable& erfc_table() {
  static const ErfcTable table;
  return table;
}

double gaussian_tail(const ErfcTable& table, double t) {
  if (t < ErfcTable::kEnd) return table(t);
  return t < kTailEnd ? far_tail(t) : 0.0;
}

}  // namespace astroid::detail
