#include "effects/adc.hpp"

#include <fmt/format.h>

#include "astroid/core/digitise.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed Adc::is_needed(const SceneSummary& scene) const {
  return {true,
          fmt::format("{} bits, rounding to nearest: {:.4g} e- rms of quantisation noise", scene.mission->ccd.adc_bits,
                      scene.mission->ccd.gain.value() / kSqrt12),
          0.0, 0.0};
}

void Adc::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const double top = adc_top(context.scene.mission().ccd.adc_bits);
  const std::span<float> digital = state.computed().pixels.pixels().subspan(strip.begin, strip.size());
  const std::span<std::uint8_t> flags = state.computed().flags.pixels().subspan(strip.begin, strip.size());
  state.clipped_pixels += static_cast<std::int64_t>(digitise_pixels(state.analog.pixels(strip), top, digital, flags));
}

}  // namespace astroid
