// Pixels whose dark current jumps.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds dark current in the high state of pixels that jump between two states (F92), chosen once by detector pixel. The
/// state holds for an exposure and is a pure function of its number.
class TelegraphPixels final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "telegraph-pixels",
                                    .id = StreamId{98},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "Machlup1954",
                                    .role = ImageRole::kVaryingLight,
                                    .pixels = PixelSet::kExposed,
                                    .per_read = false};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
