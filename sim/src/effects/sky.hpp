// Sky background.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the constant sky, in detected electrons.
class Sky final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "sky", StreamId{4},      EffectLevel::kSky, plane_bit::kExpected, plane_bit::kExpected, 0, RandomScope::kNone,
      "",    ImageRole::kLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
