#include "natural_spline.hpp"

#include <algorithm>
#include <cmath>

namespace astroid::detail {

namespace {

std::size_t knots(std::size_t size, std::size_t stride) {
  return (size + stride - 1) / stride;
}

}  // namespace

void natural_spline(std::span<const double> value, std::size_t stride, std::span<double> curvature,
                    std::vector<double>& scratch) {
  const std::size_t n = knots(value.size(), stride);
  if (n == 0) return;
  curvature[0] = 0.0;
  curvature[(n - 1) * stride] = 0.0;
  if (n < 3) return;
  // Thomas algorithm for m[i-1] + 4 m[i] + m[i+1] = 6 (v[i-1] - 2 v[i] + v[i+1]), m = 0 at both ends.
  scratch.assign(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 4.0 - scratch[i - 1];
    const double right =
        6.0 * ((value[(i - 1) * stride] - value[i * stride]) + (value[(i + 1) * stride] - value[i * stride]));
    scratch[i] = 1.0 / pivot;
    curvature[i * stride] = (right - curvature[(i - 1) * stride]) / pivot;
  }
  for (std::size_t i = n - 2; i >= 1; --i) curvature[i * stride] -= scratch[i] * curvature[(i + 1) * stride];
}

double spline_value(std::span<const double> value, std::span<const double> curvature, std::size_t stride, double t) {
  const std::size_t n = knots(value.size(), stride);
  if (n == 1) return value[0];
  const double last = static_cast<double>(n - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(t), 0.0, last));
  const double b = t - static_cast<double>(i);
  const double a = 1.0 - b;
  const double linear = a * value[i * stride] + b * value[(i + 1) * stride];
  return linear + ((a * a * a - a) * curvature[i * stride] + (b * b * b - b) * curvature[(i + 1) * stride]) / 6.0;
}

}  // namespace astroid::detail
