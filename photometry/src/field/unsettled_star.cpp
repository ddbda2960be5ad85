#include "field/unsettled_star.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace astroid::detail {

bool is_unsettled(const ModelStar& star) {
  constexpr double kSettled = 0.1;  // of an error
  return !(std::abs(star.change) <= kSettled);
}

FittedStar settle(const FieldSolver& field, std::size_t star) {
  constexpr double kFree = 2.0;  // FWHM
  constexpr std::size_t kMost = 8;
  const ModelStar& centre = field.stars()[star];
  std::vector<std::uint32_t> near;
  field.neighbours().find(centre.x, centre.y, kFree * field.reach().fwhm(), near);
  const auto distance = [&](std::uint32_t i) {
    return std::hypot(field.stars()[i].x - centre.x, field.stars()[i].y - centre.y);
  };
  std::erase(near, static_cast<std::uint32_t>(star));
  std::ranges::stable_sort(near, [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
  if (near.size() > kMost) near.resize(kMost);
  near.insert(near.begin(), static_cast<std::uint32_t>(star));
  const int half = field.reach().core() + static_cast<int>(std::ceil(kFree * field.reach().fwhm()));
  const int side = 2 * half + 1;
  GroupPixels pixels;
  pixels.box = {static_cast<int>(std::floor(centre.x + 0.5)) - half,
                static_cast<int>(std::floor(centre.y + 0.5)) - half, side, side};
  pixels.box = intersect(pixels.box, {0, 0, field.weight().nx(), field.weight().ny()});
  const std::size_t n = pixels.box.size();
  std::vector<double> light(n, 0.0);
  std::vector<double> stamp(n);
  std::vector<GroupStar> group;
  for (const std::uint32_t i : near) {
    const ModelStar& s = field.stars()[i];
    group.push_back({{s.x, s.y}, s.flux});
    field.psf().integrate({s.x, s.y}, pixels.box, stamp);
    for (std::size_t k = 0; k < n; ++k) light[k] += s.flux * stamp[k];
  }
  std::size_t k = 0;
  for (int y = pixels.box.y0; y < pixels.box.y1(); ++y)
    for (int x = pixels.box.x0; x < pixels.box.x1(); ++x, ++k) {
      const auto weight = static_cast<double>(*field.weight().at(x, y));
      const auto residual = static_cast<double>(*field.residual().at(x, y));
      pixels.usable.push_back(weight > 0.0 ? 1 : 0);
      pixels.electrons.push_back(residual + light[k]);
      // The weight is that of all light; the group's own photons are added by the fit.
      const double floor = field.pixels().read_variance > 0.0 ? field.pixels().read_variance : 1.0;
      pixels.variance.push_back(weight > 0.0 ? std::max(floor, 1.0 / weight - light[k]) : floor);
    }
  GroupFitSettings settings;
  settings.fit_background = false;
  return fit_group(pixels, field.psf(), group, settings).stars.front();
}

}  // namespace astroid::detail
