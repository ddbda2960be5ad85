#include "astroid/analysis/contamination.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace astroid {

namespace {

/// Stars in order of x, to find those near a place without looking at all.
class SortedByX {
 public:
  explicit SortedByX(std::span<const FieldStar> stars) : stars_(stars), order_(stars.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [stars](std::size_t a, std::size_t b) { return stars[a].position.x < stars[b].position.x; });
  }

  template <class Visit>
  void near(PixelPosition place, double reach, Visit visit) const {
    auto it = std::lower_bound(order_.begin(), order_.end(), place.x - reach,
                               [this](std::size_t star, double x) { return stars_[star].position.x < x; });
    for (; it != order_.end() && stars_[*it].position.x <= place.x + reach; ++it) {
      if (std::abs(stars_[*it].position.y - place.y) <= reach) visit(*it);
    }
  }

 private:
  std::span<const FieldStar> stars_;
  std::vector<std::size_t> order_;
};

/// The weights of an aperture on the pixels of a box.
std::vector<double> aperture_weights(const StarEstimator& estimator, const PixelLayout& layout, Rectangle& box) {
  const Rectangle& region = layout.regions()[estimator.region];
  const std::size_t columns = static_cast<std::size_t>(region.nx);
  std::vector<std::pair<int, int>> places;
  Rectangle bounds{};
  int x1 = 0;
  int y1 = 0;
  for (std::size_t i = 0; i < estimator.aperture_terms; ++i) {
    const std::size_t index = estimator.terms[i].pixel - layout.offset(estimator.region);
    const int x = region.x0 + static_cast<int>(index % columns);
    const int y = region.y0 + static_cast<int>(index / columns);
    if (places.empty()) {
      bounds.x0 = x;
      bounds.y0 = y;
      x1 = x + 1;
      y1 = y + 1;
    }
    bounds.x0 = std::min(bounds.x0, x);
    bounds.y0 = std::min(bounds.y0, y);
    x1 = std::max(x1, x + 1);
    y1 = std::max(y1, y + 1);
    places.emplace_back(x, y);
  }
  bounds.nx = x1 - bounds.x0;
  bounds.ny = y1 - bounds.y0;
  std::vector<double> weights(bounds.size(), 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t at =
        static_cast<std::size_t>(places[i].second - bounds.y0) * static_cast<std::size_t>(bounds.nx) +
        static_cast<std::size_t>(places[i].first - bounds.x0);
    weights[at] += static_cast<double>(estimator.terms[i].weight);
  }
  box = bounds;
  return weights;
}

}  // namespace

std::vector<std::vector<Contaminant>> strongest_contaminants(std::span<const StarEstimator> estimators,
                                                             const PixelLayout& layout, const GroundModel& model,
                                                             double reach, std::size_t count) {
  const SortedByX sorted(model.stars);
  std::vector<std::vector<Contaminant>> lists(estimators.size());
  std::vector<double> fractions;
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    const StarEstimator& estimator = estimators[e];
    const double all_light = estimator.budget.target + estimator.budget.contaminants;
    if (estimator.aperture_terms == 0 || !(all_light > 0.0)) continue;
    Rectangle box;
    const std::vector<double> weights = aperture_weights(estimator, layout, box);
    fractions.resize(weights.size());
    const FieldStar& target = model.stars[estimator.star];
    std::vector<Contaminant>& list = lists[e];
    sorted.near(target.position, reach, [&](std::size_t neighbour) {
      if (neighbour == estimator.star) return;
      const FieldStar& star = model.stars[neighbour];
      model.psf->integrate(star.position, box, fractions);
      const double enclosed = std::inner_product(weights.begin(), weights.end(), fractions.begin(), 0.0);
      const double spr = star.electrons * enclosed / all_light;
      if (!(spr > 0.0)) return;
      list.push_back(
          {star.id, star.position.x - target.position.x, star.position.y - target.position.y, star.electrons, spr});
    });
    std::stable_sort(list.begin(), list.end(),
                     [](const Contaminant& a, const Contaminant& b) { return a.spr > b.spr; });
    if (list.size() > count) list.resize(count);
  }
  return lists;
}

double planet_significance(const TransitSeries& transits, double nsr_1h) {
  return transits.depth * std::sqrt(transits.duration * transits.count) / nsr_1h;
}

double contaminant_significance(const TransitSeries& eclipses, double spr_k, double spr_tot, double nsr_1h) {
  return eclipses.depth * spr_k * std::sqrt(eclipses.duration * eclipses.count) / ((1.0 - spr_tot) * nsr_1h);
}

double critical_spr(const TransitSeries& eclipses, double spr_tot, double nsr_1h, double threshold) {
  return threshold * (1.0 - spr_tot) * nsr_1h / (eclipses.depth * std::sqrt(eclipses.duration * eclipses.count));
}

}  // namespace astroid
