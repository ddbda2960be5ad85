// erfc for the edges of pixels: a table of Taylor expansions, an order of magnitude faster than a library erfc.
#pragma once

#include <array>
#include <cstddef>

namespace astroid::detail {

/// Beyond this |t|, erfc(t) < 1e-150 and counts as zero, so that products of two tails are never denormal.
inline constexpr double kTailEnd = 18.5;

/// erfc(t) on 0 <= t < 6 by the Taylor expansion about the nearest of 193 nodes.
///
/// @accuracy  5e-16 + 4 t^2 * 1.1e-16 relative (test: GaussianPsf.KeepsItsRelativeAccuracyFarFromTheStar). The same
/// bits on every
///            x86-64 processor: the nodes are built in 80-bit arithmetic, without any library function.
/// @complexity 20 multiplications and additions
class ErfcTable {
 public:
  static constexpr double kEnd = 6.0;
  ErfcTable();
  [[nodiscard]] double operator()(double t) const {
    const auto node = static_cast<std::size_t>(t * kNodesPerUnit + 0.5);
    const Coefficients& c = nodes_[node];
    const double d = t - static_cast<double>(node) * kSpacing;
    const double d2 = d * d;
    // Even and odd parts side by side: two short chains of dependent operations instead of one long one.
    const double even = c[0] + d2 * (c[2] + d2 * (c[4] + d2 * (c[6] + d2 * c[8])));
    const double odd = c[1] + d2 * (c[3] + d2 * (c[5] + d2 * (c[7] + d2 * c[9])));
    return even + d * odd;
  }

 private:
  static constexpr double kNodesPerUnit = 32.0;
  static constexpr double kSpacing = 1.0 / kNodesPerUnit;
  static constexpr std::size_t kNodes = 193;  // 0 … 6 with both ends
  static constexpr std::size_t kTerms = 10;   // remainder (2 t d)^10 / 10! = 1.5e-14 at t = 6, d = 1/64
  using Coefficients = std::array<double, kTerms>;
  std::array<Coefficients, kNodes> nodes_{};
};

/// The one table, built at first use.
const ErfcTable& erfc_table();

/// erfc(t) for t >= 0, zero from kTailEnd on. @accuracy 1e-12 relative
double gaussian_tail(const ErfcTable& table, double t);

}  // namespace astroid::detail
