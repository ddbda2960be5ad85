// Gain: electrons become ADU.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Divides by the gain (e-/ADU): the one place where the unit changes.
class GainEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"gain",
                                    StreamId{10},
                                    EffectLevel::kReadout,
                                    plane_bit::kSampled,
                                    plane_bit::kAnalog,
                                    0,
                                    RandomScope::kNone,
                                    "",
                                    ImageRole::kNone,
                                    PixelSet::kAll,
                                    true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
