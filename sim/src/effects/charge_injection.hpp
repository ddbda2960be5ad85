// Lines of injected charge.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the same charge to every pixel of every nth row, which keeps traps filled (F37). It is injected with Poisson
/// noise: expected electrons.
class ChargeInjection final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "charge-injection",
                                    .id = StreamId{52},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Short2013",
                                    .role = ImageRole::kOffset};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
