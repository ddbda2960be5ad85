// Brighter-fatter effect.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Moves charge across pixel boundaries that collected charge has shifted (F71), after photon noise.
class BrighterFatter final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "brighter-fatter",
                                    .id = StreamId{53},
                                    .level = EffectLevel::kPixelSample,
                                    .reads = plane_bit::kSampled,
                                    .writes = plane_bit::kSampled,
                                    .halo_px = 16,
                                    .random = RandomScope::kNone,
                                    .source = "Guyonnet2015"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  /// As far as the range that is configured.
  void support(const Scene& scene, std::vector<Rectangle>& regions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
