// Slow drift of the line of sight.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Lets the spacecraft drift: linearly, and by the thermo-elastic polynomial of each quarter; shared by all cameras.
class DriftEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"drift", StreamId{20},         EffectLevel::kPointing, 0U, plane_bit::kAttitude,
                                    0,       RandomScope::kStatic, "Jannsen2024"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
