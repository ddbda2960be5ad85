#include <cmath>

#include "astroid/core/psf.hpp"

namespace astroid {

namespace {

constexpr double kFarthest = 1e9;  // px; keeps every coordinate within an int

}  // namespace

Rectangle stamp_box(PixelPosition centre, double half_width) {
  const double reach = std::abs(centre.x) + std::abs(centre.y) + std::abs(half_width);
  if (!(reach < kFarthest)) return {};
  const auto first = [half_width](double c) { return static_cast<int>(std::ceil(c - half_width - 0.5)); };
  const auto last = [half_width](double c) { return static_cast<int>(std::floor(c + half_width + 0.5)); };
  const int x0 = first(centre.x);
  const int y0 = first(centre.y);
  return {x0, y0, last(centre.x) - x0 + 1, last(centre.y) - y0 + 1};
}

}  // namespace astroid
