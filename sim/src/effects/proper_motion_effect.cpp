#include "effects/proper_motion_effect.hpp"

#include <fmt/format.h>

namespace astroid {

EffectNeed ProperMotionEffect::is_needed(const SceneSummary& scene) const {
  if (!scene.mission->field.proper_motion) return {false, "proper motion is left out by the configuration", 0.0, 0.0};
  if (scene.moved_stars == 0) return {false, "no star has a proper motion", 0.0, 0.0};
  // It costs nothing once the scene is built, so it is never left out for being small.
  return {true,
          fmt::format("{} stars moved by up to {:.3g} px from their epochs to the middle of the run, J{:.3f}",
                      scene.moved_stars, scene.proper_motion_px, scene.epoch),
          scene.flux_change(scene.proper_motion_px) * scene.brightest_target_electrons, 0.0};
}

void ProperMotionEffect::apply(ExposureState& /*state*/, const EffectContext& /*context*/,
                               const Strip& /*strip*/) const {}

}  // namespace astroid
