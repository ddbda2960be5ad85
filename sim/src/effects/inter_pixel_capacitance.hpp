// Inter-pixel capacitance.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// What is read of a pixel follows its neighbours' charge a little (F91); charge itself stays where it is.
class InterPixelCapacitance final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "inter-pixel-capacitance",
                                    .id = StreamId{91},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kSampled,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 1,
                                    .random = RandomScope::kNone,
                                    .source = "Moore2006",
                                    .pixels = PixelSet::kExposed,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
