// Stray light.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds light from outside the field: a level at the centre of the detector and a gradient.
class StrayLight final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "stray-light",      StreamId{25}, EffectLevel::kSky, plane_bit::kExpected, plane_bit::kExpected, 0,
      RandomScope::kNone, "",           ImageRole::kLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
