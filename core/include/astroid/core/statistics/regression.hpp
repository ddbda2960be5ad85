// Straight lines and polynomial trends through data.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace astroid {

/// y = at_centre + slope (x - centre), with errors from the scatter about the line.
struct Line {
  double centre =
      std::numeric_limits<double>::quiet_NaN();  ///< weighted mean of x, where value and slope are independent
  double at_centre = std::numeric_limits<double>::quiet_NaN();
  double slope = std::numeric_limits<double>::quiet_NaN();
  double at_centre_error = std::numeric_limits<double>::quiet_NaN();
  double slope_error = std::numeric_limits<double>::quiet_NaN();
  double scatter =
      std::numeric_limits<double>::quiet_NaN();  ///< weighted rms about the line with n - 2 in the denominator
  std::size_t used = 0;
  [[nodiscard]] double operator()(double x) const { return at_centre + slope * (x - centre); }
};

/// Least squares, centred, so that an offset of x costs no digits.
///
/// Points where x or y is not finite are left out. NaN for fewer than two different x; errors NaN for fewer than three.
/// @param weights  inverse variances up to a common factor, or empty for equal ones.
Line fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weights = {});

/// A polynomial as a sum of polynomials that are orthogonal on the data: no offset or scale of x makes it
/// ill-conditioned.
/// @source Forsythe1957.
class PolynomialTrend {
 public:
  /// Least squares of this degree; points where x or y is not finite are left out. The degree is lowered to one less
  /// than the number of different x.
  PolynomialTrend(std::span<const double> x, std::span<const double> y, int degree);
  [[nodiscard]] double operator()(double x) const;
  [[nodiscard]] int degree() const { return static_cast<int>(terms_.size()) - 1; }  ///< -1 without data

 private:
  struct Term {
    double coefficient = 0.0;
    double shift = 0.0;  // P_{k+1} = (u - shift) P_k - previous P_{k-1}
    double previous = 0.0;
  };
  double centre_ = 0.0;
  double per_half_range_ = 1.0;  // u = (x - centre) / half range
  std::vector<Term> terms_;
};

}  // namespace astroid
