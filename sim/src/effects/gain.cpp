#include "effects/gain.hpp"

#include <fmt/format.h>

#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed GainEffect::is_needed(const SceneSummary& scene) const {
  return {true, fmt::format("electrons become ADU at {:.6g} e-/ADU", scene.mission->ccd.gain.value()), 0.0, 0.0};
}

void GainEffect::apply(ExposureState& state, const EffectContext& context) const {
  const double gain = context.scene.mission().ccd.gain.value();
  const std::span<const double> electrons = state.sampled.pixels();
  const std::span<double> counts = state.analog.pixels();
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = electrons[i] / gain;
}

}  // namespace astroid
