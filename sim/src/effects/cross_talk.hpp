// Cross-talk between the nodes that are read at the same time.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds to each pixel a share of the signals that the other nodes read at the same moment: those of the pixels that
/// mirror it in the middle of the detector, for nodes read outwards from it.
///
/// Reference pixels are left alone: they mirror reference pixels, which hold next to nothing.
/// @source F82
class CrossTalk final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "cross-talk",
                                    .id = StreamId{73},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = kWholeColumn,
                                    .random = RandomScope::kNone,
                                    .source = "Freyhammer2001"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void support(const Scene& scene, std::vector<Rectangle>& regions) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
