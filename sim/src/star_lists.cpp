#include "star_lists.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr int kCell = 64;  // px

int cell(double v) {
  return static_cast<int>(std::floor(v / kCell));
}

/// How far a star gets from its nominal place, px.
double excursion(const SceneStar& star, const Attitude& farthest) {
  constexpr double kFastest = 2.1e-4;  // change of the spacecraft's velocity in half a year, in units of c
  const AttitudeJacobian& j = star.motion;
  const AberrationJacobian& a = star.aberration;
  const double aberration =
      det::hypot(det::hypot(det::hypot(a.x[0], a.x[1]), a.x[2]), det::hypot(det::hypot(a.y[0], a.y[1]), a.y[2]));
  return kFastest * aberration + det::hypot(j.dx_dyaw, j.dy_dyaw) * farthest.yaw +
         det::hypot(j.dx_dpitch, j.dy_dpitch) * farthest.pitch + det::hypot(j.dx_droll, j.dy_droll) * farthest.roll;
}

}  // namespace

std::vector<std::vector<RenderedStar>> star_lists(const Scene& scene, const PlanKnobs& knobs,
                                                  std::span<const Rectangle> areas, const Attitude& farthest,
                                                  StarChoice choice) {
  constexpr double kRounding = 1.0;  // px: of the stamp's edges
  std::map<std::pair<int, int>, std::vector<std::uint32_t>> cells;
  std::vector<double> reach(scene.stars().size());
  double widest = 0.0;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    const SceneStar& star = scene.stars()[i];
    if (!(star.electrons > 0.0)) continue;  // so its response is not 0 either
    const bool constant = star.variability < 0;
    if (choice != StarChoice::kAll && constant != (choice == StarChoice::kConstant)) continue;
    reach[i] = knobs.stamp_half_width(star.electrons) + excursion(star, farthest) + kRounding;
    widest = std::max(widest, reach[i]);
    cells[{cell(star.position.x), cell(star.position.y)}].push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<std::vector<RenderedStar>> lists;
  lists.reserve(areas.size());
  std::vector<std::uint32_t> found;
  for (const Rectangle& area : areas) {
    found.clear();
    for (int cy = cell(area.y0 - widest); cy <= cell(area.y1() + widest); ++cy)
      for (int cx = cell(area.x0 - widest); cx <= cell(area.x1() + widest); ++cx) {
        const auto stars = cells.find({cx, cy});
        if (stars == cells.end()) continue;
        for (const std::uint32_t i : stars->second)
          if (!intersect(stamp_box(scene.stars()[i].position, reach[i]), area).empty()) found.push_back(i);
      }
    std::ranges::sort(found);
    std::vector<RenderedStar>& list = lists.emplace_back();
    list.reserve(found.size());
    for (const std::uint32_t i : found) {
      const SceneStar& star = scene.stars()[i];
      // Light as it enters the optics: conditions and responses take away what they take.
      list.push_back({star.position, star.electrons / star.response, knobs.stamp_half_width(star.electrons),
                      star.motion, star.aberration, star.variability});
    }
  }
  return lists;
}

Attitude farthest_attitude(const PrepareContext& context) {
  const Attitude& scale = context.knobs.polynomial.scale;
  const Attitude& farthest = context.attitude.farthest;
  return {farthest.yaw + 2.0 * scale.yaw, farthest.pitch + 2.0 * scale.pitch, farthest.roll + 2.0 * scale.roll};
}

std::vector<std::vector<std::vector<RenderedStar>>> star_lists(const PrepareContext& context,
                                                               std::span<const Strip> strips, StarChoice choice) {
  std::vector<Rectangle> areas;
  for (const Strip& strip : strips) areas.insert(areas.end(), strip.areas.begin(), strip.areas.end());
  auto lists = star_lists(context.scene, context.knobs, areas, farthest_attitude(context), choice);
  std::vector<std::vector<std::vector<RenderedStar>>> by_strip;
  by_strip.reserve(strips.size());
  auto list = lists.begin();
  for (const Strip& strip : strips) {
    const auto end = list + static_cast<std::ptrdiff_t>(strip.areas.size());
    by_strip.emplace_back(std::move_iterator(list), std::move_iterator(end));
    list = end;
  }
  return by_strip;
}

}  // namespace astroid
