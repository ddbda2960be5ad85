// Pointing jitter from a model.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Points the spacecraft where the Ornstein-Uhlenbeck process, or the noise with a given spectrum, is at each step of
/// the exposure; shared by all cameras.
class JitterModelEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "jitter-model",       StreamId{1}, EffectLevel::kPointing,    0U,
      plane_bit::kAttitude, 0,           RandomScope::kPerExposure, "UhlenbeckOrnstein1930"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
