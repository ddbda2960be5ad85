#include "effects/pixel_offset.hpp"

#include <fmt/format.h>

#include "astroid/core/math.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed PixelOffset::is_needed(const SceneSummary& scene) const {
  const double rms = (scene.mission->cmos.offset_rms * scene.mission->ccd.gain).value();
  if (rms <= 0.0) return {false, "all pixels have the same offset (spread 0)", 0.0, 0.0};
  if (const auto harmless = common_to_reads(scene, rms, fmt::format("{:.4g} e- rms of fixed offsets", rms)))
    return *harmless;
  constexpr double kWorst = 3.0;  // sigma: of some hundred stars one has as much
  const double bias = kWorst * rms * det::sqrt(scene.aperture_pixels);
  return {
      bias > scene.tightest_tolerance(),
      fmt::format("fixed offsets of {:.4g} e- rms add up to {:.4g} e- to an aperture; the tightest flux tolerance is "
                  "{:.3g} e-",
                  rms, bias, scene.tightest_tolerance()),
      bias, 0.0};
}

void PixelOffset::prepare(CameraState& camera, const PrepareContext& context) const {
  const double rms = context.scene.mission().cmos.offset_rms.value();
  camera.cmos.offset = Plane<float, unit::Adu>(camera.layout);
  draw_fixed_pattern(context.stream, camera.cmos.offset, [&](double normal) { return rms * normal; });
}

void PixelOffset::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  add_values(state.analog.pixels(strip), context.camera.cmos.offset.pixels().subspan(strip.begin, strip.size()));
}

}  // namespace astroid
