// Vignetting: light lost away from the optical axis.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Multiplies stars, ghosts, sky and stray light by the vignetting of their pixel.
///
/// The map is interpolated (four-point Lagrange) between exact values every 16 px of the detector, so a window has the
/// full frame's bits.
/// @accuracy 1e-7, of single precision (test: Vignetting.IsThatOfThePixelsFieldAngle)
class Vignetting final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"vignetting",         StreamId{42},         EffectLevel::kPixelMean,
                                    plane_bit::kExpected, plane_bit::kExpected, 0,
                                    RandomScope::kNone,   "Jannsen2024",        ImageRole::kResponse};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
