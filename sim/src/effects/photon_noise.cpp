#include "effects/photon_noise.hpp"

#include <fmt/format.h>

#include "astroid/core/math.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

EffectNeed PhotonNoise::is_needed(const SceneSummary& scene) const {
  const bool light = scene.peak_pixel_bound > 0.0;
  return {light,
          light ? fmt::format("photon noise of the brightest target is {:.4g} e- rms per exposure",
                              det::sqrt(scene.brightest_target_electrons))
                : "no electron is expected in any pixel",
          0.0, light ? 1.0 : 0.0};
}

void PhotonNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  pixel_poisson(context.stream, noise_of(strip, state.exposure), state.expectation(strip), state.sampled.pixels(strip));
}

}  // namespace astroid
