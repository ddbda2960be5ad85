#include "effects/photon_noise.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/core/math.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
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
  const Mission& mission = context.scene.mission();
  const int reads = mission.simulation.type == DetectorType::kCmos ? mission.cmos.reads : 1;
  const std::span<double> sampled = state.sampled.pixels(strip);
  PixelPlaces places = noise_of(strip, state.number);
  if (reads <= 1) {
    pixel_poisson(context.stream, places, state.expectation(strip), sampled);
    return;
  }
  if (state.read == 0) {  // at the beginning of the exposure
    std::ranges::fill(sampled, 0.0);
    return;
  }
  // What has come since the read before.
  const std::size_t size = strip.size();
  state.scratch.resize(2 * size);
  const std::span<double> mean = std::span(state.scratch).first(size);
  const std::span<double> counts = std::span(state.scratch).last(size);
  scale_values(state.expectation(strip), 1.0 / (reads - 1), mean);
  places.read = static_cast<std::uint16_t>(state.read);
  pixel_poisson(context.stream, places, mean, counts);
  for (std::size_t i = 0; i < size; ++i) sampled[i] += counts[i];
}

}  // namespace astroid
