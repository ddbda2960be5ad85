// Pointing jitter from a file.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Points the spacecraft where the attitude file says at each step of the exposure; shared by all cameras.
class JitterFileEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"jitter-file",        StreamId{2}, EffectLevel::kPointing, 0U,
                                    plane_bit::kAttitude, 0,           RandomScope::kNone,     ""};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
