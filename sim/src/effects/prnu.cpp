#include "effects/prnu.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed Prnu::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.prnu;
  if (rms <= 0.0) return {false, "the pixel response is uniform (PRNU 0)", 0.0, 0.0};
  return response_need(scene, rms, fmt::format("{:.3g} % rms", 100.0 * rms));
}

void Prnu::prepare(CameraState& camera, const PrepareContext& context) const {
  const double rms = context.scene.mission().ccd.prnu;
  camera.prnu = Plane<float, unit::Relative>(camera.layout);
  draw_fixed_pattern(context.stream, camera.prnu, [&](double normal) { return std::max(0.0, 1.0 + rms * normal); });
}

void Prnu::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  multiply_values(state.expected.pixels(strip), context.camera.prnu.pixels().subspan(strip.begin, strip.size()));
}

}  // namespace astroid
