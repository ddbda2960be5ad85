#include "effects/ghosts.hpp"

#include <fmt/format.h>

#include "astroid/core/disc.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/rolling_shutter.hpp"

namespace astroid {

EffectNeed Ghosts::is_needed(const SceneSummary& scene) const {
  if (scene.ghosts == 0) return {false, "no star has a ghost on the detector", 0.0, 0.0};
  EffectNeed need = background_need(scene, scene.ghost_light, "the light of all ghosts in one place");
  need.why = fmt::format("{} ghosts touch the detector; {}", scene.ghosts, need.why);
  return need;
}

void Ghosts::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const double radius = context.scene.mission().telescope.ghosts.radius.value();
  const double per_area = state.conditions.throughput / (kPi * radius * radius);
  for (const Ghost& ghost : context.scene.ghosts()) {
    for (std::size_t a = 0; a < strip.areas.size(); ++a) {
      look_at_row(state, strip.areas[a].y0);
      const PixelShift shift = displacement(ghost.motion, state.attitude.mean);
      const PixelPosition centre{ghost.position.x + shift.dx, ghost.position.y + shift.dy};
      const Rectangle box = stamp_box(centre, radius);
      const Rectangle part = intersect(box, strip.areas[a]);
      if (part.empty()) continue;
      const auto view = state.expected.view(strip, a);
      for (int y = part.y0; y < part.y1(); ++y)
        for (int x = part.x0; x < part.x1(); ++x)
          view.at(x, y) += ghost.electrons * per_area * disc_coverage(centre, radius, x, y);
    }
  }
}

}  // namespace astroid
