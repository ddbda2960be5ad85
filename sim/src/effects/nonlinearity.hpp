// Non-linearity of the readout electronics.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Bends the signal above the bias: I + a0 + a1 I + a2 I², in ADU. @source F33
class NonLinearity final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "non-linearity",
                                    .id = StreamId{72},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Jannsen2024",
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
