// Offset of single pixels.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds a fixed offset to what is read of each pixel, mean 0, Gaussian. Addressed by detector pixel.
class PixelOffset final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "pixel-offset",
                                    .id = StreamId{95},
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
