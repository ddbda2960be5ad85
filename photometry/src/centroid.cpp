#include "astroid/photometry/centroid.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

namespace {

// First moment about the middle of a profile; mirrored elements are subtracted first, so that symmetry gives 0 exactly.
double moment_about_middle(std::span<const double> profile) {
  const std::size_t n = profile.size();
  double sum = 0.0;
  for (std::size_t i = 0; i < n / 2; ++i)
    sum += 0.5 * static_cast<double>(n - 1 - 2 * i) * (profile[n - 1 - i] - profile[i]);
  return sum;
}

}  // namespace

Centroid centroid_of(const GroupPixels& pixels, std::span<const double> weight) {
  const Rectangle& box = pixels.box;
  ASTROID_CHECK_EQ(pixels.electrons.size(), box.size());
  ASTROID_CHECK_EQ(pixels.variance.size(), box.size());
  ASTROID_CHECK_EQ(pixels.usable.size(), box.size());
  if (!weight.empty()) ASTROID_CHECK_EQ(weight.size(), box.size());
  Centroid result;
  std::vector<double> columns(static_cast<std::size_t>(std::max(0, box.nx)), 0.0);
  std::vector<double> rows(static_cast<std::size_t>(std::max(0, box.ny)), 0.0);
  std::size_t used = 0;
  std::size_t k = 0;
  std::vector<char> use(box.size(), 0);
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (std::size_t i = 0; i < columns.size(); ++i, ++k) {
      const double w = weight.empty() ? 1.0 : weight[k];
      if (!(w > 0.0)) continue;
      if (pixels.usable[k] == 0 || !std::isfinite(pixels.electrons[k]) || !std::isfinite(pixels.variance[k])) {
        result.flags |= measurement_flag::kBadPixel;
        continue;
      }
      use[k] = 1;
      ++used;
      columns[i] += w * pixels.electrons[k];
      rows[j] += w * pixels.electrons[k];
    }
  for (const double r : rows) result.flux += r;
  const auto none = [&] {
    result.flags |= measurement_flag::kNoFlux;
    return result;
  };
  if (used == 0 || !(result.flux > 0.0) || !std::isfinite(result.flux)) return none();
  const double dx = moment_about_middle(columns) / result.flux;
  const double dy = moment_about_middle(rows) / result.flux;
  // Light of both signs can have its moment anywhere.
  if (!(std::abs(dx) <= 0.5 * (box.nx - 1)) || !(std::abs(dy) <= 0.5 * (box.ny - 1))) return none();
  const PixelPosition middle{box.x0 + 0.5 * (box.nx - 1), box.y0 + 0.5 * (box.ny - 1)};
  result.position = {middle.x + dx, middle.y + dy};
  if (used < 2) return result;
  std::array<double, 3> sums{};
  k = 0;
  for (int y = box.y0; y < box.y1(); ++y)
    for (int x = box.x0; x < box.x1(); ++x, ++k) {
      if (use[k] == 0) continue;
      const double w = weight.empty() ? 1.0 : weight[k];
      const double v = w * w * (std::max(0.0, pixels.variance[k]) + std::max(0.0, pixels.electrons[k]));
      const double u = x - result.position.x;
      const double t = y - result.position.y;
      sums[0] += v * u * u;
      sums[1] += v * u * t;
      sums[2] += v * t * t;
    }
  for (std::size_t i = 0; i < sums.size(); ++i) result.covariance[i] = sums[i] / result.flux / result.flux;
  return result;
}

}  // namespace astroid
