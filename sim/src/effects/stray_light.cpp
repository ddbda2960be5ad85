#include "effects/stray_light.hpp"

#include <cmath>

#include "astroid/sim/scene.hpp"
#include "bilinear_light.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed StrayLight::is_needed(const SceneSummary& scene) const {
  const StrayLightSettings& stray = scene.mission->field.stray_light;
  const double level = (stray.level * scene.mission->simulation.exposure_time).value();
  return background_need(scene, level * (1.0 + std::fabs(stray.gradient_x) + std::fabs(stray.gradient_y)),
                         "stray light in the brightest corner");
}

void StrayLight::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const StrayLightSettings& stray = context.scene.mission().field.stray_light;
  const double level = (stray.level * context.scene.mission().simulation.exposure_time).value();
  const double x = level * stray.gradient_x;
  const double y = level * stray.gradient_y;
  add_light(BilinearLight(context.scene.detector(), {level - x - y, level + x - y, level - x + y, level + x + y}),
            strip, state.expected);
}

}  // namespace astroid
