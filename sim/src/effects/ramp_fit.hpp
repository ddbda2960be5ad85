// The fitted ramp is what is delivered.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Replaces the last read by the counts that the fit of the ramp gives for the whole exposure, above the bias, rounded:
/// the fit is made on board from digitised reads.
class RampFitEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "ramp-fit",
                                    .id = StreamId{97},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kRamp | plane_bit::kFlags,
                                    .writes = plane_bit::kDigital | plane_bit::kFlags,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Brandt2024",
                                    .pixels = PixelSet::kAll,
                                    .per_read = false};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
