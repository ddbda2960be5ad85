#include "effects/photon_noise.hpp"

#include <fmt/format.h>

#include "astroid/core/distributions.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

EffectNeed PhotonNoise::is_needed(const SceneSummary& scene) const {
  const bool light = scene.peak_pixel_bound > 0.0;
  return {light,
          light ? fmt::format("photon noise of the brightest target is {:.4g} e- rms per exposure",
                              det::sqrt(scene.brightest_target_electrons))
                : "no electron is expected in any pixel",
          0.0, light ? 1.0 : 0.0};
}

void PhotonNoise::apply(ExposureState& state, const EffectContext& context) const {
  for (std::size_t r = 0; r < state.expected.layout().regions().size(); ++r) {
    const auto expected = state.expected.view(r);
    const auto sampled = state.sampled.view(r);
    const Rectangle& area = expected.area();
    for (int y = area.y0; y < area.y1(); ++y)
      poisson_row(context.stream, {.x0 = area.x0, .y = y, .exposure = static_cast<std::uint32_t>(state.exposure)},
                  expected.row(y), sampled.row(y));
  }
}

}  // namespace astroid
