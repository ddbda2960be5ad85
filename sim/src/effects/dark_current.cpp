#include "effects/dark_current.hpp"

#include <algorithm>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

namespace {
Electrons dark_electrons(const Mission& mission) {
  return mission.ccd.dark_current * mission.simulation.exposure_time;
}
}  // namespace

EffectNeed DarkCurrent::is_needed(const SceneSummary& scene) const {
  return background_need(scene, dark_electrons(*scene.mission).value(), "dark current");
}

void DarkCurrent::prepare(CameraState& camera, const PrepareContext& context) const {
  const double level = dark_electrons(context.scene.mission()).value();
  const double dsnu = context.scene.mission().ccd.dsnu;
  camera.dark = Plane<float, unit::ExpectedElectrons>(camera.layout);
  draw_fixed_pattern(context.stream, camera.dark,
                     [&](double normal) { return level * std::max(0.0, 1.0 + dsnu * normal); });
}

void DarkCurrent::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  add_values(state.expected.pixels(strip), context.camera.dark.pixels().subspan(strip.begin, strip.size()));
}

}  // namespace astroid
