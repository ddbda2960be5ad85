#include "effects/readout_noise.hpp"

#include <fmt/format.h>

#include "astroid/sim/scene.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed ReadoutNoise::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.readout_noise.value();
  if (rms <= 0.0) return {false, "the readout is noiseless (readout noise 0)", 0.0, 0.0};
  const double variance = rms * rms;
  // The quantisation error of an image with less noise than this depends on the signal, so noise may not be left out
  // there.
  const double rest = scene.faintest_target_electrons + scene.pixel_noise_variance - variance;
  const double ratio = rest > 0.0 ? variance * scene.aperture_pixels / rest : 1.0;
  return {ratio > kVarianceTolerance,
          fmt::format("{:.4g} e- rms per pixel; all other variance of the faintest target is at least {:.4g} e-²", rms,
                      rest),
          0.0, ratio};
}

void ReadoutNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const double rms = context.scene.mission().ccd.readout_noise.value();
  add_pixel_normals(context.stream, noise_of(strip, state.exposure), rms, state.sampled.pixels(strip));
}

}  // namespace astroid
