#include "astroid/photometry/aperture.hpp"

#include <algorithm>
#include <cmath>

namespace astroid {

namespace {

// Area between an arc and its chord over the radius squared: asin(s) - s √(1-s²), where s = half chord / radius <= √½.
double unit_segment(double s) {
  // Halving the arc twice brings s below sin(π/16): the triangles cut off are exact, and the series below is short.
  constexpr int kHalvings = 2;
  double triangles = 0.0;
  double copies = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double one_plus_cosine = 1.0 + std::sqrt((1.0 - s) * (1.0 + s));
    triangles += copies * s * (s * s / one_plus_cosine);
    copies *= 2.0;
    s = s / std::sqrt(2.0 * one_plus_cosine);
  }
  // ∫ 2 s²/√(1-s²) ds = 2 Σ_k C(2k,k)/4^k s^(2k+3)/(2k+3); at s² <= 0.038 twelve terms leave less than 1e-17.
  constexpr int kTerms = 12;
  const double square = s * s;
  double binomial = 1.0;
  double power = 2.0 * s * square;
  double series = 0.0;
  for (int k = 0; k < kTerms; ++k) {
    series += binomial * power / (2 * k + 3);
    binomial *= (2 * k + 1) / static_cast<double>(2 * k + 2);
    power *= square;
  }
  return triangles + copies * series;
}

double leg(double hypotenuse, double side) {
  return std::sqrt((hypotenuse - side) * (hypotenuse + side));
}

// The same in the first quadrant: 0 <= x0 <= x1, 0 <= y0 <= y1.
double quadrant_overlap(double radius, double x0, double x1, double y0, double y1) {
  if (x0 >= radius || y0 >= radius || x1 <= x0 || y1 <= y0) return 0.0;
  // The arc leaves the top edge at x = a and meets the bottom edge at x = b; the rectangle is full left of a.
  const double a = y1 < radius ? std::clamp(leg(radius, y1), x0, x1) : x0;
  const double b = std::clamp(leg(radius, y0), x0, x1);
  const double full = (a - x0) * (y1 - y0);
  if (b <= a) return full;
  const double height_a = std::clamp(leg(radius, a), y0, y1) - y0;
  const double height_b = std::clamp(leg(radius, b), y0, y1) - y0;
  const double width = b - a;
  const double drop = height_a - height_b;
  const double half_chord = std::min(0.5 * std::sqrt(width * width + drop * drop) / radius, 1.0);
  return full + 0.5 * width * (height_a + height_b) + radius * radius * unit_segment(half_chord);
}

}  // namespace

double disc_rectangle_overlap(double radius, double x0, double x1, double y0, double y1) {
  const double far_x = std::max(std::abs(x0), std::abs(x1));
  const double far_y = std::max(std::abs(y0), std::abs(y1));
  const double area = (x1 - x0) * (y1 - y0);
  const double near_x = std::max({0.0, x0, -x1});
  const double near_y = std::max({0.0, y0, -y1});
  if (near_x * near_x + near_y * near_y >= radius * radius) return 0.0;
  if (far_x * far_x + far_y * far_y <= radius * radius) return area;
  // Fold the rectangle along the axes into the first quadrant; most lie in one quadrant already.
  double overlap = 0.0;
  for (const double sign_x : {-1.0, 1.0}) {
    const double right = sign_x > 0.0 ? x1 : -x0;
    if (right <= 0.0) continue;
    const double left = std::max(0.0, sign_x > 0.0 ? x0 : -x1);
    for (const double sign_y : {-1.0, 1.0}) {
      const double top = sign_y > 0.0 ? y1 : -y0;
      if (top <= 0.0) continue;
      const double bottom = std::max(0.0, sign_y > 0.0 ? y0 : -y1);
      overlap += quadrant_overlap(radius, left, right, bottom, top);
    }
  }
  return std::min(overlap, area);
}

Rectangle aperture_box(PixelPosition centre, double radius) {
  // Far outside any detector an aperture touches nothing; the limit keeps the casts below defined.
  constexpr double kFarthestPixel = 1e8;
  const bool usable = std::isfinite(centre.x) && std::isfinite(centre.y) && radius > 0.0 && radius < kFarthestPixel &&
                      std::abs(centre.x) < kFarthestPixel && std::abs(centre.y) < kFarthestPixel;
  if (!usable) return {};
  const int x0 = static_cast<int>(std::floor(centre.x - radius + 0.5));
  const int y0 = static_cast<int>(std::floor(centre.y - radius + 0.5));
  const int x1 = static_cast<int>(std::ceil(centre.x + radius + 0.5));
  const int y1 = static_cast<int>(std::ceil(centre.y + radius + 0.5));
  return {x0, y0, x1 - x0, y1 - y0};
}

void aperture_overlap(PixelPosition centre, double radius, const Rectangle& box, std::span<double> overlap) {
  std::size_t i = 0;
  for (int y = box.y0; y < box.y1(); ++y) {
    for (int x = box.x0; x < box.x1(); ++x, ++i) {
      const double left = x - 0.5 - centre.x;
      const double bottom = y - 0.5 - centre.y;
      overlap[i] = disc_rectangle_overlap(radius, left, left + 1.0, bottom, bottom + 1.0);
    }
  }
}

}  // namespace astroid
