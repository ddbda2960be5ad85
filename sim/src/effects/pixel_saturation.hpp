// Full well of pixels that do not bloom.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Ends the charge of each pixel at the full well, at each read: what is more is drained, as by an anti-blooming gate.
/// A read at full well has no part in the fit of a ramp.
class PixelSaturation final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "pixel-saturation",
                                    .id = StreamId{90},
                                    .level = EffectLevel::kPixelSample,
                                    .reads = plane_bit::kSampled,
                                    .writes = plane_bit::kSampled | plane_bit::kFlags,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "",
                                    .pixels = PixelSet::kExposed,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
