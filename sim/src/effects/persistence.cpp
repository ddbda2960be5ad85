#include "effects/persistence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

PersistenceKernel persistence_kernel(const Mission& mission) {
  constexpr double kShareOfAccuracy = 0.01;
  constexpr double kPpm = 1e-6;
  return {mission.cmos.persistence, mission.simulation.cycle, mission.simulation.exposure_time,
          kShareOfAccuracy * kPpm * mission.simulation.accuracy.value()};
}

EffectNeed Persistence::is_needed(const SceneSummary& scene) const {
  double held = 0.0;
  for (const double fraction : scene.mission->cmos.persistence.fraction) held += fraction;
  if (!(held > 0.0)) return {false, "no charge stays in traps from exposure to exposure", 0.0, 0.0};
  // As much as is taken from an exposure is released in all later ones together, and never more in one of them.
  return moved_charge_need(scene, held, fmt::format("what {:.3g} % of traps take and release", 100.0 * held));
}

void Persistence::prepare(CameraState& camera, const PrepareContext& context) const {
  camera.cmos.persistence = std::make_shared<const PersistenceKernel>(persistence_kernel(context.scene.mission()));
}

void Persistence::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const std::span<double> expected = state.expected.pixels(strip);
  for (const PastImage& past : state.past)
    add_released(past.electrons->pixels().subspan(strip.begin, strip.size()), past.share, expected);
  take_trapped(context.camera.cmos.persistence->taken(), context.scene.mission().ccd.full_well, expected);
}

}  // namespace astroid
