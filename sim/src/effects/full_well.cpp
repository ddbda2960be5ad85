#include "effects/full_well.hpp"

#include <span>
#include <vector>

#include "astroid/sim/blooming.hpp"
#include "astroid/sim/scene.hpp"
#include "bloom_reach.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed FullWell::is_needed(const SceneSummary& scene) const {
  return full_well_need(scene);
}

void FullWell::support(const Scene& scene, std::vector<Rectangle>& regions) const {
  if (!scene.mission().ccd.blooming) return;
  const BloomReach reach(scene);
  for (Rectangle& region : regions) region = reach.support(region);
}

void FullWell::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  const double full_well = ccd.full_well.value();
  for (std::size_t r = 0; r < strip.areas.size(); ++r) {
    const auto electrons = state.sampled.view(strip, r);
    const auto flags = state.computed().flags.view(r);
    state.lost_electrons +=
        ccd.blooming ? bloom(electrons, full_well, &flags) : clip_full_well(electrons, full_well, &flags);
  }
}

}  // namespace astroid
