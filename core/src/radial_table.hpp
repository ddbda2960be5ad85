// A smooth function of the distance from a star, quick to look up.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace astroid::detail {

/// A function of r on [0, end] by polynomials through its values at Chebyshev's points of equal panels; 0 beyond.
///
/// The same bits on every processor, as far as those of the function are.
/// @accuracy  1e-13 of the function's size nearby, when a panel is a quarter of the length over which it changes
///            (test: RadialTable.IsTheFunction)
/// @complexity  at(): a square root and 12 products
class RadialTable {
 public:
  RadialTable(const std::function<double(double r)>& function, double end, double panel);

  /// At the squared distance r2.
  [[nodiscard]] double at(double r2) const;

 private:
  static constexpr std::size_t kTerms = 12;  // even
  double end2_;
  double per_panel_;
  std::vector<std::array<double, kTerms>> panels_;  // coefficients of t^k, t from -1 to 1 in the panel
};

}  // namespace astroid::detail
