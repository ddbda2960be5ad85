#include "effects/reset_noise.hpp"

#include <fmt/format.h>

#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed ResetNoise::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->cmos.reset_noise.value();
  if (rms <= 0.0) return {false, "resets leave no charge (reset noise 0)", 0.0, 0.0};
  if (const auto harmless = common_to_reads(scene, rms, fmt::format("{:.4g} e- rms of reset noise", rms)))
    return *harmless;
  return noise_need(scene, rms, "e- rms of reset noise per pixel");
}

void ResetNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  const double rms = mission.cmos.reset_noise.value() / mission.ccd.gain.value();
  add_pixel_normals(context.stream, noise_of(strip, state.number), rms, state.analog.pixels(strip));
}

}  // namespace astroid
