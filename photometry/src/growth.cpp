#include "astroid/photometry/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/statistics/robust.hpp"
#include "astroid/photometry/aperture.hpp"

namespace astroid {

namespace {

// Light within each radius, e-; empty if a pixel cannot be used.
std::vector<double> light_within(const Frame& frame, const std::vector<std::vector<double>>& level,
                                 PixelPosition centre, std::span<const double> radii) {
  const auto pixels = frame.pixels.view(0);
  const auto flags = frame.flags.view(0);
  const Rectangle box = aperture_box(centre, radii.back());
  const Rectangle& area = pixels.area();
  if (box.size() == 0 || intersect(box, area).size() != box.size()) return {};
  std::vector<double> sums(radii.size(), 0.0);
  std::vector<double> overlap(box.size());
  for (std::size_t k = 0; k < radii.size(); ++k) {
    aperture_overlap(centre, radii[k], box, overlap);
    std::size_t i = 0;
    for (int y = box.y0; y < box.y1(); ++y) {
      for (int x = box.x0; x < box.x1(); ++x, ++i) {
        if (overlap[i] == 0.0) continue;
        const double value = static_cast<double>(pixels.at(x, y));
        if ((flags.at(x, y) & ~pixel_flag::kTruth) != 0 || !std::isfinite(value)) return {};
        sums[k] +=
            overlap[i] * (value - level[static_cast<std::size_t>(y - area.y0)][static_cast<std::size_t>(x - area.x0)]);
      }
    }
  }
  for (double& sum : sums) sum *= frame.header.gain.value();
  return sums;
}

}  // namespace

GrowthCurve measure_growth(const Frame& frame, const BackgroundMap& background, std::span<const PixelPosition> stars,
                           std::span<const double> light, const GrowthSettings& settings) {
  if (!(settings.radius > 0.0 && settings.radius < settings.reference && std::isfinite(settings.reference) &&
        settings.steps > 0))
    throw InputError(Problem{.parameter = "aperture radius, reference radius",
                             .value = fmt::format("{}, {} px", settings.radius, settings.reference),
                             .expected = "0 < aperture radius < reference radius",
                             .message = "a curve of growth needs light outside of the aperture"});
  ASTROID_CHECK_EQ(stars.size(), light.size());
  std::vector<double> radii;
  for (int k = 0; k <= settings.steps; ++k)
    radii.push_back(settings.radius + (settings.reference - settings.radius) * k / settings.steps);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < stars.size(); ++i)
    if (std::isfinite(light[i]) && light[i] > 0.0) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return light[a] != light[b] ? light[a] > light[b] : a < b; });
  std::vector<std::vector<double>> level(static_cast<std::size_t>(background.area().ny));
  constexpr double kNeighbour = 0.01;                        // of the star's light
  constexpr double kFree = 1.5;                              // reference radii
  constexpr std::size_t kLookAt = 20;                        // times as many as are needed; fainter ones tell little
  std::vector<std::vector<double>> rings(radii.size() - 1);  // of each star, over its light in the aperture
  GrowthCurve curve;
  for (std::size_t n = 0; n < std::min(order.size(), kLookAt * settings.most_stars); ++n) {
    if (curve.stars >= settings.most_stars) break;
    const std::size_t i = order[n];
    const PixelPosition centre = stars[i];
    const double free = kFree * settings.reference;
    const bool lonely = std::none_of(order.begin(), order.end(), [&](std::size_t j) {
      return j != i && std::abs(stars[j].x - centre.x) < free && std::abs(stars[j].y - centre.y) < free &&
             light[j] > kNeighbour * light[i];
    });
    if (!lonely) continue;
    const Rectangle box = intersect(aperture_box(centre, settings.reference), background.area());
    for (int y = box.y0; y < box.y1(); ++y) {
      auto& row = level[static_cast<std::size_t>(y - background.area().y0)];
      if (!row.empty()) continue;
      row.resize(static_cast<std::size_t>(background.area().nx));
      background.level_row(y, row);
    }
    const std::vector<double> sums = light_within(frame, level, centre, radii);
    if (sums.empty() || !(sums[0] > 0.0)) continue;
    for (std::size_t k = 0; k + 1 < radii.size(); ++k) rings[k].push_back((sums[k + 1] - sums[k]) / sums[0]);
    ++curve.stars;
  }
  if (curve.stars < settings.fewest_stars) return curve;
  std::vector<double> grown{1.0};
  std::vector<double> variance{0.0};
  for (const auto& ring : rings) {
    const RobustSpread spread = robust_spread(ring);
    const double middle = spread.centre;
    // A median's error is √(π/2) times that of a mean.
    const double error = std::sqrt(0.5 * kPi / static_cast<double>(ring.size())) * spread.value;
    grown.push_back(grown.back() + middle);
    variance.push_back(variance.back() + error * error);
  }
  const double all = grown.back();
  curve.radius = radii;
  for (std::size_t k = 0; k < grown.size(); ++k) {
    curve.light.push_back(grown[k] / all);
    // What lies within r and what lies beyond are independent: d(g/G) from the rings on either side.
    const double inside = variance[k] * (all - grown[k]) * (all - grown[k]);
    const double outside = (variance.back() - variance[k]) * grown[k] * grown[k];
    curve.error.push_back(std::sqrt(inside + outside) / (all * all));
  }
  return curve;
}

}  // namespace astroid
