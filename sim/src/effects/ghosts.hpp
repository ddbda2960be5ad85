// Ghosts: reflections of bright stars, on the other side of the optical axis.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds a uniform disc for every bright star of the catalogue, mirrored through the optical axis, with a given part of
/// the star's light and exact coverage of pixels.
///
/// Discs move opposite to their stars with the mean attitude of an exposure: what moves within it would only soften the
/// disc's edge.
class Ghosts final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"ghosts",
                                    StreamId{43},
                                    EffectLevel::kOptics,
                                    plane_bit::kStars | plane_bit::kAttitude | plane_bit::kExpected,
                                    plane_bit::kExpected,
                                    0,
                                    RandomScope::kNone,
                                    "",
                                    ImageRole::kLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
