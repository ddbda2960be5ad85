// Charge-transfer inefficiency.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Leaves charge behind while rows move to the register below row 0 and then along it (F36, F37). With two or four
/// readout nodes the right half of a row moves to the right; what trails across the middle is lost.
/// Traps begin every readout empty, rows apart in the register too.
class Cti final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "cti",
                                    .id = StreamId{54},
                                    .level = EffectLevel::kPixelSample,
                                    .reads = plane_bit::kSampled,
                                    .writes = plane_bit::kSampled,
                                    .halo_px = kWholeColumn,
                                    .random = RandomScope::kNone,
                                    .source = "Short2013",
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  /// Of the simple model the rows and columns within a trail ahead of a region, of traps all of them; and what trails
  /// into the overscan.
  void support(const Scene& scene, std::vector<Rectangle>& regions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
