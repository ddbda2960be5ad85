// Analogue-to-digital conversion.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Clamps to the ADC's range, then rounds half to even; never floors, which would bias every pixel by half an ADU.
class Adc final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"adc",
                                    StreamId{12},
                                    EffectLevel::kReadout,
                                    plane_bit::kAnalog,
                                    plane_bit::kDigital | plane_bit::kFlags,
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
