#include "effects/pixel_saturation.hpp"

#include "astroid/sim/blooming.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed PixelSaturation::is_needed(const SceneSummary& scene) const {
  return full_well_need(scene);
}

void PixelSaturation::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const double full_well = context.scene.mission().ccd.full_well.value();
  const std::span<double> electrons = state.sampled.pixels(strip);
  const std::span<std::uint8_t> flags = state.computed().flags.pixels().subspan(strip.begin, strip.size());
  state.lost_electrons += clip_full_well(electrons, full_well, flags);
}

}  // namespace astroid
