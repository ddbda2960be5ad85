#include "effects/gain.hpp"

#include <fmt/format.h>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed GainEffect::is_needed(const SceneSummary& scene) const {
  return {true, fmt::format("electrons become ADU at {:.6g} e-/ADU", scene.mission->ccd.gain.value()), 0.0, 0.0};
}

void GainEffect::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const double per_gain = 1.0 / context.scene.mission().ccd.gain.value();
  scale_values(state.sampled.pixels(strip), per_gain, state.analog.pixels(strip));
}

}  // namespace astroid
