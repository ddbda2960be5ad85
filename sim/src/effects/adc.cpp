#include "effects/adc.hpp"

#include <fmt/format.h>

#include "astroid/sim/digitise.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed Adc::is_needed(const SceneSummary& scene) const {
  return {true,
          fmt::format("{} bits, rounding to nearest: {:.4g} e- rms of quantisation noise", scene.mission->ccd.adc_bits,
                      scene.mission->ccd.gain.value() / kSqrt12),
          0.0, 0.0};
}

void Adc::apply(ExposureState& state, const EffectContext& context) const {
  const double top = adc_top(context.scene.mission().ccd.adc_bits);
  const std::span<const double> analog = state.analog.pixels();
  const std::span<float> digital = state.frame.pixels.pixels();
  const std::span<std::uint8_t> flags = state.frame.flags.pixels();
  for (std::size_t i = 0; i < analog.size(); ++i) digital[i] = digitise(analog[i], top, flags[i]);
  for (const std::uint8_t flag : flags) state.clipped_pixels += (flag & pixel_flag::kAdcSaturated) != 0 ? 1 : 0;
}

}  // namespace astroid
