#include <algorithm>
#include <cmath>
#include <vector>

#include "psf/psf_fit.hpp"

namespace astroid::detail {

namespace {

struct CorePixel {
  double squared;   // residual, e-²
  double variance;  // e-²
  double own;       // e-, of the star
};

constexpr double kShare = 0.95;
constexpr double kSquaredSigmas = 3.841458820694124;  // that kShare of normal values are within

// Of residual² / variance, at the share above.
double quantile(std::vector<double>& scratch, const std::vector<CorePixel>& pixels, double misfit) {
  scratch.clear();
  for (const CorePixel& p : pixels) {
    const double doubt = misfit * p.own;
    scratch.push_back(p.squared / (p.variance + doubt * doubt));
  }
  const auto nth = scratch.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(scratch.size() - 1));
  std::ranges::nth_element(scratch, nth);
  return *nth;
}

}  // namespace

double psf_misfit(const FieldSolver& field, std::span<const std::size_t> stars) {
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * field.reach().fwhm())));
  const int side = 2 * half + 1;
  std::vector<CorePixel> pixels;
  std::vector<double> fractions(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (const std::size_t index : stars) {
    const ModelStar& star = field.stars()[index];
    const Rectangle box{static_cast<int>(std::floor(star.x + 0.5)) - half,
                        static_cast<int>(std::floor(star.y + 0.5)) - half, side, side};
    field.psf().integrate({star.x, star.y}, box, fractions);
    std::size_t k = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x, ++k) {
        const auto weight = static_cast<double>(*field.weight().at(x, y));
        if (!(weight > 0.0)) continue;
        const auto residual = static_cast<double>(*field.residual().at(x, y));
        pixels.push_back({residual * residual, 1.0 / weight, star.flux * fractions[k]});
      }
  }
  if (pixels.empty()) return 0.0;
  std::vector<double> scratch;
  if (quantile(scratch, pixels, 0.0) <= kSquaredSigmas) return 0.0;
  double low = 0.0;
  double high = 1.0;
  constexpr int kHalvings = 12;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (quantile(scratch, pixels, middle) > kSquaredSigmas ? low : high) = middle;
  }
  return high;
}

}  // namespace astroid::detail
