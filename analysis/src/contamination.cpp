#include "astroid/analysis/contamination.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <numeric>
#include <tuple>

#include "astroid/core/worker_pool.hpp"

namespace astroid {

namespace {

/// Stars in bands of y and in each by x, to find those near a place without looking at all.
class Neighbourhood {
 public:
  /// @param reach  how far neighbours may be, in x and in y.
  Neighbourhood(std::span<const FieldStar> stars, double reach) : reach_(reach), stars_(stars) {
    order_.reserve(stars.size());
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const PixelPosition place = stars[i].position;
      if (std::isfinite(place.x) && std::isfinite(place.y))
        order_.push_back({.band = band_of(place.y), .x = place.x, .star = i});
    }
    std::ranges::sort(order_);
  }

  template <class Visit>
  void visit(PixelPosition place, Visit visit) const {
    for (double band = band_of(place.y - reach_); band <= band_of(place.y + reach_); ++band) {
      const Entry begin{.band = band, .x = place.x - reach_, .star = 0};
      for (auto it = std::ranges::lower_bound(order_, begin);
           it != order_.end() && it->band == band && it->x <= place.x + reach_; ++it)
        if (std::abs(stars_[it->star].position.y - place.y) <= reach_) visit(it->star);
    }
  }

 private:
  struct Entry {
    double band;  // whole number
    double x;
    std::size_t star;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  [[nodiscard]] double band_of(double y) const { return std::floor(y / reach_); }

  double reach_;
  std::span<const FieldStar> stars_;
  std::vector<Entry> order_;
};

/// A neighbour and its share.
struct Share {
  double spr;
  std::size_t star;
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
                                                             double reach, std::size_t count, int threads) {
  const Neighbourhood neighbourhood(model.stars, reach);
  std::vector<std::vector<Contaminant>> lists(estimators.size());
  // Larger shares first; equal ones from left to right.
  const auto before = [&](const Share& a, const Share& b) {
    return std::tuple(-a.spr, model.stars[a.star].position.x, a.star) <
           std::tuple(-b.spr, model.stars[b.star].position.x, b.star);
  };
  parallel_for(threads, estimators.size(), [&](std::size_t /*worker*/, std::size_t e) {
    const StarEstimator& estimator = estimators[e];
    const double all_light = estimator.budget.target + estimator.budget.contaminants;
    if (estimator.aperture_terms == 0 || !(all_light > 0.0)) return;
    Rectangle box;
    const std::vector<double> weights = aperture_weights(estimator, layout, box);
    std::vector<double> fractions(weights.size());
    std::vector<Share> shares;
    const FieldStar& target = model.stars[estimator.star];
    neighbourhood.visit(target.position, [&](std::size_t neighbour) {
      if (neighbour == estimator.star) return;
      const FieldStar& star = model.stars[neighbour];
      model.psf->integrate(star.position, box, fractions);
      const double enclosed = std::inner_product(weights.begin(), weights.end(), fractions.begin(), 0.0);
      const double spr = star.electrons * enclosed / all_light;
      if (spr > 0.0) shares.push_back({spr, neighbour});
    });
    const auto end = shares.begin() + static_cast<std::ptrdiff_t>(std::min(count, shares.size()));
    std::partial_sort(shares.begin(), end, shares.end(), before);
    for (auto it = shares.begin(); it != end; ++it) {
      const FieldStar& star = model.stars[it->star];
      lists[e].push_back(
          {star.id, star.position.x - target.position.x, star.position.y - target.position.y, star.electrons, it->spr});
    }
  });
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
