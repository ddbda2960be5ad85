#include "effects/drift.hpp"

#include "effects/displacement_need.hpp"
#include "effects/jitter_need.hpp"

namespace astroid {

EffectNeed DriftEffect::is_needed(const SceneSummary& scene) const {
  return displacement_need(scene, scene.drift_px, "drift");
}

void DriftEffect::apply(ExposureState& state, const EffectContext& context, const Strip& /*strip*/) const {
  take_attitude(state, context.attitude);
}

}  // namespace astroid
