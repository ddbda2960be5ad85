// Dark current with its fixed non-uniformity (DSNU).
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds rate x exposure time x (1 + DSNU n) with n normal and fixed for each pixel, never below 0 (F39).
class DarkCurrent final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"dark-current",       StreamId{6},          EffectLevel::kPixelMean,
                                    plane_bit::kExpected, plane_bit::kExpected, 0,
                                    RandomScope::kStatic, "Jannsen2024",        ImageRole::kOffset};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
