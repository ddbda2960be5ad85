// Reset (kTC) noise.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the charge that a reset leaves on the node, normal with the stated rms: new in each exposure, the same in all
/// reads of it, so that differences between reads do not have it.
class ResetNoise final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "reset-noise",
                                    .id = StreamId{93},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "Vacca2004",
                                    .pixels = PixelSet::kAll,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
