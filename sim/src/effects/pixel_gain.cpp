#include "effects/pixel_gain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed PixelGain::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->cmos.gain_rms;
  if (rms <= 0.0) return {false, "all pixels have the same gain (spread 0)", 0.0, 0.0};
  return response_need(scene, rms, fmt::format("{:.3g} % rms", 100.0 * rms));
}

void PixelGain::prepare(CameraState& camera, const PrepareContext& context) const {
  const double rms = context.scene.mission().cmos.gain_rms;
  camera.cmos.gain = Plane<float, unit::Relative>(camera.layout);
  draw_fixed_pattern(context.stream, camera.cmos.gain,
                     [&](double normal) { return std::max(0.0, 1.0 + rms * normal); });
}

void PixelGain::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  multiply_values(state.analog.pixels(strip), context.camera.cmos.gain.pixels().subspan(strip.begin, strip.size()));
}

}  // namespace astroid
