#include "effects/zodiacal_sky.hpp"

#include <array>

#include "astroid/sim/scene.hpp"
#include "bilinear_light.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed ZodiacalSky::is_needed(const SceneSummary& scene) const {
  if (scene.mission->field.sky != SkyModel::kZodiacal) return {false, "the sky is constant", 0.0, 0.0};
  return background_need(scene, scene.sky, "the sky on the axis in the middle of the run");
}

void ZodiacalSky::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Scene& scene = context.scene;
  const Seconds time = scene.mid_time(state.exposure);
  const Seconds exposure = scene.mission().simulation.exposure_time;
  std::array<double, 4> corners{};
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = (scene.sky_at_corner(i, time) * exposure).value();
  add_light(BilinearLight(scene.detector(), corners), strip, state.expected);
}

}  // namespace astroid
