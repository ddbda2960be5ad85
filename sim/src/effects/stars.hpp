// The stars: the scene's light through the PSF onto the pixels.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds every star's expected electrons with the plan's renderer, stamps and jitter treatment.
///
/// Stars are added to a pixel in catalogue order, so a pixel has the same bits in a window and in the full frame.
class Stars final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"stars",
                                    StreamId{3},
                                    EffectLevel::kOptics,
                                    plane_bit::kStars | plane_bit::kAttitude,
                                    plane_bit::kExpected,
                                    0,
                                    RandomScope::kNone,
                                    "Marchiori2019",
                                    ImageRole::kLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
