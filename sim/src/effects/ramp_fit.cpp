#include "effects/ramp_fit.hpp"

#include <fmt/format.h>

#include <cmath>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed RampFitEffect::is_needed(const SceneSummary& scene) const {
  const Mission& mission = *scene.mission;
  if (mission.cmos.reads <= 1) return {false, "each exposure is read once: there is no ramp to fit", 0.0, 0.0};
  const RampNoise noise = ramp_noise(mission);
  const double variance = read_variance(mission);
  const RampVariance faint = noise.variance(0.0, variance);
  return {true,
          fmt::format("the fit leaves {:.4g} e- rms of {:.4g} e- in dark pixels, and {:.4g} times the photon noise in "
                      "the faintest, rounded to counts of {} bits",
                      fitted_readout_factor(mission) * std::sqrt(variance), std::sqrt(variance),
                      std::sqrt(faint.photon), delivered_bits(mission)),
          0.0, 0.0};
}

void RampFitEffect::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  if (context.camera.cmos.ladder == nullptr) return;  // a single read is what it is
  const double top = adc_top(delivered_bits(mission));
  Frame& frame = state.computed();
  const std::span<std::uint8_t> flags = frame.flags.pixels().subspan(strip.begin, strip.size());
  state.scratch.resize(strip.size());
  finish_ramp(*context.camera.cmos.ladder, top, state.ramps.pixels(strip), state.scratch, flags);
  add_constant(state.scratch, mission.ccd.bias.value());
  digitise_pixels(state.scratch, top, frame.pixels.pixels().subspan(strip.begin, strip.size()), flags);
}

}  // namespace astroid
