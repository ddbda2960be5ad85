// Bias (offset) of the ADC.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the constant bias.
class BiasEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"bias",
                                    StreamId{11},
                                    EffectLevel::kReadout,
                                    plane_bit::kAnalog,
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
