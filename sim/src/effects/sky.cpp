#include "effects/sky.hpp"

#include <fmt/format.h>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

namespace {
Electrons sky_electrons(const Mission& mission) {
  return mission.field.sky_background * mission.simulation.exposure_time;
}
}  // namespace

EffectNeed Sky::is_needed(const SceneSummary& scene) const {
  if (scene.mission->field.sky != SkyModel::kConstant)
    return {false, "the sky is not constant: zodiacal-sky makes it", 0.0, 0.0};
  return background_need(scene, sky_electrons(*scene.mission).value(), "sky");
}

void Sky::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  add_constant(state.expected.pixels(strip), sky_electrons(context.scene.mission()).value());
}

}  // namespace astroid
