// Differential kinematic aberration.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Sets the velocity of the spacecraft relative to the start of the run; who renders stars displaces them by it.
class AberrationEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "aberration",       StreamId{22},    EffectLevel::kPointing, 0U, plane_bit::kStars, 0,
      RandomScope::kNone, "Kovalevsky2004"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
