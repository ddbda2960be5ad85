// Error of pointing the spacecraft anew.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the offset with which each quarter but the first is pointed. The turn itself, about the axis by 90 deg, puts
/// other pixels under every star: it is another scene, with another Roll, and not part of a run.
class RepointingEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "re-pointing", StreamId{21}, EffectLevel::kPointing, 0U, plane_bit::kAttitude, 0, RandomScope::kStatic, ""};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
