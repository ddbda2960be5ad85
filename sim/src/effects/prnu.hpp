// Pixel response non-uniformity.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Multiplies by the fixed response of each pixel, mean 1, Gaussian with the stated rms, never below 0.
/// The pattern is addressed by detector pixel: drawn once for a camera, the same in every exposure and window.
class Prnu final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "prnu", StreamId{5},          EffectLevel::kPixelMean, plane_bit::kExpected, plane_bit::kExpected,
      0,      RandomScope::kStatic, "DeRidder2006",          ImageRole::kResponse};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
