// Photon (shot) noise.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Draws the electrons of each pixel from the Poisson distribution of its expectation, by inverting one uniform. Of an
/// exposure with several reads it draws what each adds to the one before, from its share of the expectation.
class PhotonNoise final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"photon-noise",
                                    StreamId{7},
                                    EffectLevel::kPixelSample,
                                    plane_bit::kExpected,
                                    plane_bit::kSampled,
                                    0,
                                    RandomScope::kPerExposure,
                                    "Giles2016",
                                    ImageRole::kNone,
                                    PixelSet::kAll,
                                    true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
