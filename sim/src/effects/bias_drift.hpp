// What the bias does in time and from row to row.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the slow change of the bias.
class BiasDrift final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "bias-drift",
                                    .id = StreamId{77},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "",
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// Adds a normal offset to each row of each node, new in every exposure, to reference pixels too.
class RowOffset final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "row-offset",
                                    .id = StreamId{78},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "",
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
