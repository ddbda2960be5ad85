// Gain of single pixels.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Multiplies what is read of each pixel by its fixed gain, mean 1, Gaussian with the stated rms, never below 0: each
/// pixel has an amplifier of its own. Addressed by detector pixel.
class PixelGain final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "pixel-gain",
                                    .id = StreamId{92},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kStatic,
                                    .source = "",
                                    .pixels = PixelSet::kAll,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
