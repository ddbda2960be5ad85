#include "radial_table.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid::detail {

RadialTable::RadialTable(const std::function<double(double r)>& function, double end, double panel) : end2_(end * end) {
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(end / panel)));
  per_panel_ = static_cast<double>(count) / end;
  std::array<double, kTerms> places{};
  for (std::size_t k = 0; k < kTerms; ++k) places[k] = det::cos(kPi * (static_cast<double>(k) + 0.5) / kTerms);
  // Chebyshev's polynomials in powers of t, one after the other.
  std::array<std::array<double, kTerms>, kTerms> chebyshev{};
  chebyshev[0][0] = 1.0;
  chebyshev[1][1] = 1.0;
  for (std::size_t j = 2; j < kTerms; ++j)
    for (std::size_t k = 0; k < kTerms; ++k)
      chebyshev[j][k] = (k > 0 ? 2.0 * chebyshev[j - 1][k - 1] : 0.0) - chebyshev[j - 2][k];
  for (std::size_t p = 0; p < count; ++p) {
    std::array<double, kTerms> values{};
    for (std::size_t k = 0; k < kTerms; ++k)
      values[k] = function((static_cast<double>(p) + 0.5 + 0.5 * places[k]) / per_panel_);
    auto& powers = panels_.emplace_back();
    for (std::size_t j = 0; j < kTerms; ++j) {
      double coefficient = 0.0;
      for (std::size_t k = 0; k < kTerms; ++k)
        coefficient += values[k] * det::cos(kPi * static_cast<double>(j) * (static_cast<double>(k) + 0.5) / kTerms);
      coefficient *= (j == 0 ? 1.0 : 2.0) / kTerms;
      for (std::size_t k = 0; k <= j; ++k) powers[k] += coefficient * chebyshev[j][k];
    }
  }
}

double RadialTable::at(double r2) const {
  if (!(r2 < end2_)) return 0.0;
  const double place = std::sqrt(r2) * per_panel_;
  const auto p = std::min(static_cast<std::size_t>(place), panels_.size() - 1);
  const auto& powers = panels_[p];
  const double t = 2.0 * (place - static_cast<double>(p)) - 1.0;
  const double t2 = t * t;
  // Even and odd powers apart: two short chains instead of a long one.
  double even = powers[kTerms - 2];
  double odd = powers[kTerms - 1];
  for (std::size_t k = kTerms - 2; k > 0; k -= 2) {
    even = even * t2 + powers[k - 2];
    odd = odd * t2 + powers[k - 1];
  }
  return even + odd * t;
}

}  // namespace astroid::detail
