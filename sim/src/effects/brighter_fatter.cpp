#include "effects/brighter_fatter.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "astroid/sim/brighter_fatter.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed BrighterFatter::is_needed(const SceneSummary& scene) const {
  const BrighterFatterSettings& settings = scene.mission->ccd.brighter_fatter;
  if (settings.serial <= 0.0 && settings.parallel <= 0.0)
    return {false, "charge does not shift pixel boundaries (BrighterFatter/Serial and Parallel 0)", 0.0, 0.0};
  // Two boundaries of each kind, each shifted by all charge on one side of it, as full as the fullest pixel.
  const BoundaryShifts shifts(settings);
  double sum = 0.0;
  for (int d = 0; d < shifts.range(); ++d)
    for (int j = 0; j < shifts.range(); ++j)
      sum += (j == 0 ? 1.0 : 2.0) * (shifts.serial(d, j) + shifts.parallel(d, j));
  const double fullest = std::min(scene.peak_pixel_bound, scene.mission->ccd.full_well.value());
  return moved_charge_need(scene, sum * fullest, "collected charge");
}

void BrighterFatter::support(const Scene& scene, std::vector<Rectangle>& regions) const {
  const int range = scene.mission().ccd.brighter_fatter.range;
  for (Rectangle& r : regions)
    r = intersect(scene.detector(), {r.x0 - range, r.y0 - range, r.nx + 2 * range, r.ny + 2 * range});
}

void BrighterFatter::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const BoundaryShifts shifts(context.scene.mission().ccd.brighter_fatter);
  for (std::size_t a = 0; a < strip.areas.size(); ++a) brighter_fatter(state.sampled.view(strip, a), shifts);
}

}  // namespace astroid
