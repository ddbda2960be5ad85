#include "effects/bias.hpp"

#include <fmt/format.h>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed BiasEffect::is_needed(const SceneSummary& scene) const {
  const double bias = scene.mission->ccd.bias.value();
  return {
      bias != 0.0,
      bias != 0.0 ? fmt::format("{:.6g} ADU keep the noise above the bottom of the ADC", bias) : "the bias is 0 ADU",
      0.0, 0.0};
}

void BiasEffect::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  add_constant(state.analog.pixels(strip), context.scene.mission().ccd.bias.value());
}

}  // namespace astroid
