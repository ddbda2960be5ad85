#include "effects/jitter_model.hpp"

#include "effects/jitter_need.hpp"

namespace astroid {

EffectNeed JitterModelEffect::is_needed(const SceneSummary& scene) const {
  const JitterModel model = scene.mission->satellite.jitter.model;
  if (model != JitterModel::kRedNoise && model != JitterModel::kSpectrum)
    return {false, "no jitter model is configured", 0.0, 0.0};
  return jitter_need(scene);
}

void JitterModelEffect::apply(ExposureState& state, const EffectContext& context, const Strip& /*strip*/) const {
  take_attitude(state, context.attitude);
}

}  // namespace astroid
