// The stars by the sub-pixel renderer.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds every star's expected electrons from a map of sub-pixels, where the plan chose that renderer: the light of the
/// cells of each pixel times their sensitivity.
///
/// Works on whole tiles of the detector, laid out in the same way for every window: a pixel has the same bits in a
/// window and in the full frame.
class SubPixelStars final : public Effect {
 public:
  static constexpr EffectSpec kSpec{
      "sub-pixel-stars",    StreamId{110}, EffectLevel::kOptics, plane_bit::kStars | plane_bit::kAttitude,
      plane_bit::kExpected, kWholeColumn,  RandomScope::kNone,   "MarcosArenal2014",
      ImageRole::kLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  /// No pixel depends on another one: the tile is always made as a whole.
  void support(const Scene& scene, std::vector<Rectangle>& regions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
