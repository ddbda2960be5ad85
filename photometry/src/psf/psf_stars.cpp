#include "psf/psf_stars.hpp"

#include <algorithm>
#include <cmath>

namespace astroid::detail {

namespace {

// Whether all pixels of the core are usable and mostly of this star's light.
bool stands_alone(const FieldSolver& field, const ModelStar& star, std::vector<double>& fractions) {
  constexpr double kMostOthers = 0.5;
  const int core = field.reach().core();
  const int side = 2 * core + 1;
  const Rectangle box{static_cast<int>(std::floor(star.x + 0.5)) - core,
                      static_cast<int>(std::floor(star.y + 0.5)) - core, side, side};
  const FieldPixels& pixels = field.pixels();
  if (box.x0 < 0 || box.y0 < 0 || box.x1() > pixels.electrons.nx() || box.y1() > pixels.electrons.ny()) return false;
  fractions.resize(box.size());
  field.psf().integrate({star.x, star.y}, box, fractions);
  double own = 0.0;
  double all = 0.0;
  std::size_t k = 0;
  for (int y = box.y0; y < box.y1(); ++y)
    for (int x = box.x0; x < box.x1(); ++x, ++k) {
      if (!(*pixels.usable.at(x, y) > 0.0F)) return false;
      own += star.flux * fractions[k];
      all += static_cast<double>(*field.light().at(x, y));
    }
  return all - own < kMostOthers * own;
}

}  // namespace

std::vector<std::size_t> choose_psf_stars(const FieldSolver& field, double snr, std::size_t most) {
  const auto& stars = field.stars();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < stars.size(); ++i)
    if (stars[i].flux * std::sqrt(field.terms()[i].curvature[0]) > snr) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return stars[a].flux > stars[b].flux; });
  std::vector<std::size_t> chosen;
  std::vector<double> fractions;
  for (const std::size_t i : order) {
    if (chosen.size() == most) break;
    if (stands_alone(field, stars[i], fractions)) chosen.push_back(i);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace astroid::detail
