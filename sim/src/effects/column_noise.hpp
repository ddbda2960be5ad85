// Noise that the pixels of a column or a row share.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds one normal number to all pixels of a column, and one to all of a row, in each read: from the amplifiers at the
/// foot of the columns, and from references that change while rows are read one after the other.
class ColumnNoise final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "column-noise",
                                    .id = StreamId{94},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "Rauscher2015",
                                    .pixels = PixelSet::kAll,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
