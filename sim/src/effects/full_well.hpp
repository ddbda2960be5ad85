// Full well and blooming.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Spills what exceeds the full well along the column, half each way, into free room, and loses the rest at the edge.
class FullWell final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"full-well",
                                    StreamId{8},
                                    EffectLevel::kPixelSample,
                                    plane_bit::kSampled,
                                    plane_bit::kSampled | plane_bit::kFlags,
                                    kWholeColumn,
                                    RandomScope::kNone,
                                    "Jannsen2024",
                                    ImageRole::kNone,
                                    PixelSet::kExposed,
                                    true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  /// The rows from which charge may bloom into a region: as far as the stars in its columns can fill pixels.
  void support(const Scene& scene, std::vector<Rectangle>& regions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
