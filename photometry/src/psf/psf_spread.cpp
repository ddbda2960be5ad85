#include "psf/psf_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "small_matrix.hpp"

namespace astroid::detail {

namespace {

// Flux of one electron of PSF b, as PSF a fits it: to first order in what is left of b when a is taken out.
double flux_of_other(const FieldSolver& field, const ModelStar& star, const PixelPsf& a, const PixelPsf& b,
                     std::vector<double>& scratch) {
  const int core = field.reach().core();
  const int side = 2 * core + 1;
  const Rectangle box{static_cast<int>(std::floor(star.x + 0.5)) - core,
                      static_cast<int>(std::floor(star.y + 0.5)) - core, side, side};
  const std::size_t n = box.size();
  scratch.resize(4 * n);
  const std::span<double> p = std::span(scratch).subspan(0, n);
  const std::span<double> px = std::span(scratch).subspan(n, n);
  const std::span<double> py = std::span(scratch).subspan(2 * n, n);
  const std::span<double> other = std::span(scratch).subspan(3 * n, n);
  const PixelPosition place{star.x, star.y};
  a.integrate(place, box, p);
  a.integrate_gradient(place, box, px, py);
  b.integrate(place, box, other);
  const double floor = field.sky_at(star.x, star.y) + field.pixels().read_variance;
  std::array<double, 6> curvature{};
  std::array<double, 3> slope{};
  for (std::size_t i = 0; i < n; ++i) {
    const double variance = std::max(floor, 1.0) + star.flux * std::max(p[i], 0.0);
    const double w = 1.0 / variance;
    const double d = other[i] - p[i];
    curvature[0] += w * p[i] * p[i];
    curvature[1] += w * p[i] * px[i];
    curvature[2] += w * p[i] * py[i];
    curvature[3] += w * px[i] * px[i];
    curvature[4] += w * px[i] * py[i];
    curvature[5] += w * py[i] * py[i];
    slope[0] += w * p[i] * d;
    slope[1] += w * px[i] * d;
    slope[2] += w * py[i] * d;
  }
  const std::array<double, 9> inverse = inverse_of_symmetric(curvature);
  return 1.0 + inverse[0] * slope[0] + inverse[1] * slope[1] + inverse[2] * slope[2];
}

}  // namespace

double flux_spread(const FieldSolver& field, std::span<const std::size_t> stars, const PixelPsf& a, const PixelPsf& b) {
  if (stars.empty()) return 0.0;
  std::vector<double> scratch;
  std::vector<double> changes;
  for (const std::size_t i : stars)
    changes.push_back(std::abs(flux_of_other(field, field.stars()[i], a, b, scratch) - 1.0));
  const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 2);
  std::ranges::nth_element(changes, middle);
  constexpr double kSigmaPerMedian = 1.4826022185056018;
  return kSigmaPerMedian * *middle;
}

}  // namespace astroid::detail
