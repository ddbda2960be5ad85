// Sensitivity that varies within the pixel.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Weights the light within each pixel with the sensitivity of its cells, whose mean over the pixel is 1.
///
/// A star gives more or fewer electrons with its place in the pixel; uniform light isn't changed, so what a pixel is as
/// a whole is left to flat field and PRNU. Where all pixels are alike the response is folded into the PSF, exactly, and
/// costs nothing; where they differ the sub-pixel renderer multiplies the light of every cell. Either way it happens
/// where the light is made: this effect draws what is fixed and hands it over, and touches no pixel itself.
class IntraPixelResponse final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"intra-pixel-response", StreamId{111},     EffectLevel::kSubPixel, 0, 0, 0,
                                    RandomScope::kStatic,   "MarcosArenal2014"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
