#include "effects/repointing.hpp"

#include "effects/displacement_need.hpp"
#include "effects/jitter_need.hpp"

namespace astroid {

EffectNeed RepointingEffect::is_needed(const SceneSummary& scene) const {
  return displacement_need(scene, scene.repointing_px, "re-pointing");
}

void RepointingEffect::apply(ExposureState& state, const EffectContext& context, const Strip& /*strip*/) const {
  take_attitude(state, context.attitude);
}

}  // namespace astroid
