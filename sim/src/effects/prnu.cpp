#include "effects/prnu.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed Prnu::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.prnu;
  if (rms <= 0.0) return {false, "the pixel response is uniform (PRNU 0)", 0.0, 0.0};
  // The largest error of a flux is that of a star whose light is all in one pixel.
  const double bias = rms * scene.brightest_target_electrons;
  const double gradient = rms * scene.psf.gradient * scene.attitude_rms_px;
  const double flux = scene.brightest_target_electrons;
  const double variance_ratio = flux > 0.0 ? gradient * gradient / scene.relative_variance_in_bin(flux) : 0.0;
  const bool needed = rms > scene.accuracy || variance_ratio > kVarianceTolerance;
  return {needed,
          fmt::format("{:.3g} % rms changes each flux by up to {:.3g} ppm, the accuracy asked for is {:.3g} ppm",
                      100.0 * rms, 1e6 * rms, 1e6 * scene.accuracy),
          bias, variance_ratio};
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
