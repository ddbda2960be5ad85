// Natural cubic splines through equally spaced knots.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace astroid::detail {

/// Second derivatives at the knots 0, 1, 2, … of the natural spline through `value[i * stride]`; zero for fewer than 3.
/// @param curvature  [out] same stride.
void natural_spline(std::span<const double> value, std::size_t stride, std::span<double> curvature,
                    std::vector<double>& scratch);

/// The spline at position t in units of the knot distance; the end pieces are continued beyond the ends.
[[nodiscard]] double spline_value(std::span<const double> value, std::span<const double> curvature, std::size_t stride,
                                  double t);

}  // namespace astroid::detail
