// Large-scale flat field.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Multiplies by a fixed pattern with a power-law spatial spectrum, mean 1, never below 0 (F70). It is that of the
/// whole detector, whichever part is computed.
class FlatField final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "flat-field",
                                    .id = StreamId{50},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kStatic,
                                    .source = "Timmer1995",
                                    .role = ImageRole::kResponse};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
