// Takes the reads of a ramp into its fit.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Keeps of each read what the fit needs of it (F90); weights are those for the charge that a pixel is expected to
/// hold.
class RampReads final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "ramp-reads",
                                    .id = StreamId{96},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kExpected | plane_bit::kDigital | plane_bit::kFlags,
                                    .writes = plane_bit::kRamp,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Brandt2024",
                                    .pixels = PixelSet::kAll,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
