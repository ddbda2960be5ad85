#include "neighbour_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr double kStep = 0.5;       // px, of the distances at which light is tabulated
constexpr double kLost = 1e-9;      // of a star's light: farther out it has none
constexpr double kFarthest = 40.0;  // px
constexpr std::array<int, 2> kMasks = {3, 5};

/// Light in a mask, and its second derivative, of a star of unit flux at a distance.
struct Wing {
  double light = std::numeric_limits<double>::infinity();  // the least
  double bend = 0.0;                                       // the most, 1/px²
};

double mask_light(const PixelPsf& psf, PixelPosition star, Rectangle mask) {
  std::array<double, 25> fractions{};
  psf.integrate(star, mask, std::span(fractions).first(mask.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < mask.size(); ++i) sum += fractions[i];
  return sum;
}

/// The pixel of a star in the middle.
Rectangle mask_around(PixelPosition star, int side) {
  return {static_cast<int>(std::lround(star.x)) - side / 2, static_cast<int>(std::lround(star.y)) - side / 2, side,
          side};
}

/// Light of a star in a mask and its second derivatives.
struct Bent {
  double light = 0.0, along_x = 0.0, along_y = 0.0;
  Bent& operator+=(const Bent& other) {
    light += other.light;
    along_x += other.along_x;
    along_y += other.along_y;
    return *this;
  }
};

Bent bent_light(const PixelPsf& psf, PixelPosition star, Rectangle mask) {
  constexpr double kDifference = 0.1;  // px
  const double here = mask_light(psf, star, mask);
  const auto bend = [&](double dx, double dy) {
    return (mask_light(psf, {star.x + dx, star.y + dy}, mask) - 2.0 * here +
            mask_light(psf, {star.x - dx, star.y - dy}, mask)) /
           (kDifference * kDifference);
  };
  return {here, bend(kDifference, 0.0), bend(0.0, kDifference)};
}

Bent bent_light(const PixelPsf& psf, const SceneStar& star, Rectangle mask) {
  const Bent unit = bent_light(psf, star.position, mask);
  return {star.electrons * unit.light, star.electrons * unit.along_x, star.electrons * unit.along_y};
}

/// At 0, kStep, 2 kStep … from the middle of the mask.
std::vector<Wing> tabulate(const PixelPsf& psf, int side) {
  const PixelPosition place = psf.places().front();
  const int x0 = static_cast<int>(std::floor(place.x));
  const int y0 = static_cast<int>(std::floor(place.y));
  const Rectangle mask{x0 - side / 2, y0 - side / 2, side, side};
  const double reach = std::min(psf.stamp_half_width(kLost) + side, kFarthest);
  std::vector<Wing> wings(static_cast<std::size_t>(std::ceil(reach / kStep)) + 2);
  // An eighth of the circle would do for a round PSF.
  constexpr std::array<std::array<double, 2>, 8> kDirections = {{{1.0, 0.0},
                                                                 {0.0, 1.0},
                                                                 {-1.0, 0.0},
                                                                 {0.0, -1.0},
                                                                 {0.7071067811865476, 0.7071067811865476},
                                                                 {-0.7071067811865476, 0.7071067811865476},
                                                                 {-0.7071067811865476, -0.7071067811865476},
                                                                 {0.7071067811865476, -0.7071067811865476}}};
  for (std::size_t k = 0; k < wings.size(); ++k)
    for (const auto& direction : kDirections)
      for (const double phase : {-0.25, 0.25}) {
        const double distance = kStep * static_cast<double>(k);
        const PixelPosition star{x0 + phase + distance * direction[0], y0 - phase + distance * direction[1]};
        const Bent bent = bent_light(psf, star, mask);
        wings[k].light = std::min(wings[k].light, bent.light);
        wings[k].bend = std::max({wings[k].bend, std::abs(bent.along_x), std::abs(bent.along_y)});
      }
  // A step nearer and a step farther: places within a pixel, and what lies between the directions.
  const std::vector<Wing> measured = wings;
  for (std::size_t k = 0; k < wings.size(); ++k) {
    wings[k].light = std::min(measured[k].light, measured[std::min(k + 1, wings.size() - 1)].light);
    wings[k].bend = std::max(measured[k].bend, measured[k > 0 ? k - 1 : 0].bend);
  }
  for (std::size_t k = wings.size() - 1; k-- > 0;) wings[k].bend = std::max(wings[k].bend, wings[k + 1].bend);
  return wings;
}

/// Stars by squares as wide as a star reaches.
class Squares {
 public:
  Squares(std::span<const SceneStar> stars, double side) : stars_(stars), side_(side) {
    for (std::size_t i = 0; i < stars.size(); ++i)
      squares_[key(square(stars[i].position.x), square(stars[i].position.y))].push_back(i);
  }
  /// Calls f(star, distance) for every star but `of` within a side of it.
  template <class F>
  void for_each_near(std::size_t of, F&& f) const {
    const PixelPosition p = stars_[of].position;
    for (std::int64_t row = square(p.y) - 1; row <= square(p.y) + 1; ++row)
      for (std::int64_t column = square(p.x) - 1; column <= square(p.x) + 1; ++column) {
        const auto found = squares_.find(key(column, row));
        if (found == squares_.end()) continue;
        for (const std::size_t i : found->second) {
          const double distance = det::hypot(stars_[i].position.x - p.x, stars_[i].position.y - p.y);
          if (i != of && distance < side_) f(stars_[i], distance);
        }
      }
  }

 private:
  [[nodiscard]] std::int64_t square(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / side_));
  }
  static std::int64_t key(std::int64_t column, std::int64_t row) { return row * (std::int64_t{1} << 32) + column; }
  std::span<const SceneStar> stars_;
  double side_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> squares_;
};

}  // namespace

double neighbour_curvature(std::span<const SceneStar> stars, const std::vector<bool>& is_target, const PixelPsf& psf,
                           const SceneSummary& summary) {
  const double brightest = summary.brightest_target_electrons;
  const double own = summary.psf.curvature;
  if (!(brightest > 0.0) || !(own > 0.0)) return 1.0;
  const double tightest = summary.flux_tolerance(brightest) / brightest;
  const auto factor = [&](double bend, double light) {
    return bend / (own * light) * (tightest * light / summary.flux_tolerance(light));
  };
  double most = 1.0;
  for (const int side : kMasks) {
    const std::vector<Wing> wings = tabulate(psf, side);
    const Squares squares(stars, kStep * static_cast<double>(wings.size() - 1));
    std::vector<std::pair<double, std::size_t>> bounds;  // where more than `most` may be
    for (std::size_t i = 0; i < stars.size(); ++i) {
      if (!is_target[i] || stars[i].electrons > brightest) continue;
      double light = wings.front().light * stars[i].electrons;
      double bend = own * light;
      squares.for_each_near(i, [&](const SceneStar& star, double distance) {
        const Wing& wing = wings[static_cast<std::size_t>(distance / kStep)];
        light += star.electrons * wing.light;
        bend += star.electrons * wing.bend;
      });
      if (const double bound = factor(bend, light); bound > most) bounds.emplace_back(bound, i);
    }
    // The bounds are far above the truth where wings are steep. From the largest on, until the truth of one is above
    // the bounds that are left.
    std::ranges::sort(bounds, std::greater<>());
    for (const auto& [bound, i] : bounds) {
      if (bound <= most) break;
      const Rectangle mask = mask_around(stars[i].position, side);
      Bent sum = bent_light(psf, stars[i], mask);
      squares.for_each_near(i, [&](const SceneStar& star, double) { sum += bent_light(psf, star, mask); });
      most = std::max(most, factor(std::max(std::abs(sum.along_x), std::abs(sum.along_y)), sum.light));
    }
  }
  return most;
}

}  // namespace astroid
