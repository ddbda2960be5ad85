#include "effects/jitter_file.hpp"

#include "effects/jitter_need.hpp"

namespace astroid {

EffectNeed JitterFileEffect::is_needed(const SceneSummary& scene) const {
  if (scene.mission->satellite.jitter.model != JitterModel::kFile)
    return {false, "no attitude file is configured", 0.0, 0.0};
  return jitter_need(scene);
}

void JitterFileEffect::apply(ExposureState& state, const EffectContext& context, const Strip& /*strip*/) const {
  take_attitude(state, context.attitude);
}

}  // namespace astroid
