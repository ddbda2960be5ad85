#include "astroid/core/disc.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

/// Integral of sqrt(1 - x²) from 0 to x, |x| <= 1.
double half_disc(double x) {
  return 0.5 * (x * det::sqrt(std::max(0.0, 1.0 - x * x)) + det::asin(x));
}

/// Integral over x from a to b, both in [-1, 1], of the unit circle's half-height cut at y, with the sign of y.
double below(double a, double b, double y) {
  const double height = std::min(std::abs(y), 1.0);
  // Within +-reach the cut is what limits, outside the circle.
  const double reach = det::sqrt(std::max(0.0, 1.0 - height * height));
  const double left = std::clamp(-reach, a, b);
  const double right = std::clamp(reach, a, b);
  const double area = height * (right - left) + (half_disc(left) - half_disc(a)) + (half_disc(b) - half_disc(right));
  return y < 0.0 ? -area : area;
}

}  // namespace

double disc_coverage(PixelPosition centre, double radius, int x, int y) {
  if (!(radius > 0.0)) return 0.0;
  const double left = x - 0.5 - centre.x;
  const double bottom = y - 0.5 - centre.y;
  const double right = left + 1.0;
  const double top = bottom + 1.0;
  const double farthest_x = std::max(std::abs(left), std::abs(right));
  const double farthest_y = std::max(std::abs(bottom), std::abs(top));
  if (farthest_x * farthest_x + farthest_y * farthest_y <= radius * radius) return 1.0;
  const double a = std::clamp(left / radius, -1.0, 1.0);
  const double b = std::clamp(right / radius, -1.0, 1.0);
  const double area = below(a, b, top / radius) - below(a, b, bottom / radius);
  return std::clamp(area * radius * radius, 0.0, 1.0);
}

}  // namespace astroid
