// Rolling shutter of a CMOS detector.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Exposes each row later than the one below it by the line time: stars are where the spacecraft looks, and as bright
/// as they are, while their own rows are exposed. Bands of rows share the attitude at the time of their middle row.
/// @source F116
class RollingShutter final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "rolling-shutter",
                                    .id = StreamId{27},
                                    .level = EffectLevel::kPointing,
                                    .reads = plane_bit::kAttitude,
                                    .writes = plane_bit::kAttitude,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = ""};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// Looks where the band of a row looks, from now on. Nothing where all rows are exposed at once.
void look_at_row(ExposureState& state, int y);

}  // namespace astroid
