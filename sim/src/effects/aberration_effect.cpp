#include "effects/aberration_effect.hpp"

#include "astroid/core/units.hpp"
#include "astroid/sim/aberration.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/displacement_need.hpp"

namespace astroid {

EffectNeed AberrationEffect::is_needed(const SceneSummary& scene) const {
  if (!scene.mission->satellite.aberration) return {false, "aberration is left out by the configuration", 0.0, 0.0};
  EffectNeed need = displacement_need(scene, scene.aberration_px, "aberration");
  const double flux = scene.brightest_target_electrons;
  const double fastest = scene.psf.gradient * scene.aberration_px_per_second * flux;  // e- per second
  // Of the tolerance; conditions are those of the middle of an epoch, so they are off by half of it.
  constexpr double kShare = 0.3;
  if (need.needed && fastest > 0.0) need.steady = Seconds(2.0 * kShare * scene.flux_tolerance(flux) / fastest);
  // The velocity turns once a year, and by its eccentricity not evenly: a seventh faster covers six derivatives.
  constexpr double kTurn = 2.0 * kPi / (365.25 * kSecondsPerDay);  // per second
  constexpr double kUneven = 1.15;
  need.motion = {.px = scene.aberration_px_per_second / kTurn, .rate = kUneven * kTurn};
  return need;
}

void AberrationEffect::set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const {
  conditions.velocity = velocity_since_start(scene.mission().simulation, time);
}

void AberrationEffect::apply(ExposureState& /*state*/, const EffectContext& /*context*/, const Strip& /*strip*/) const {
}

}  // namespace astroid
