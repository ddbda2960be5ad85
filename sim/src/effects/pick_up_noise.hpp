// Interference that the readout picks up.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds a sinusoid over the detector, of a phase drawn for each exposure, to reference pixels too. @source F104
class PickUpNoise final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "pick-up-noise",
                                    .id = StreamId{79},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "",
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
