// Readout noise.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds normal noise of the stated rms (e-); electrons may become negative, as in a real signal chain.
class ReadoutNoise final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"readout-noise",
                                    StreamId{9},
                                    EffectLevel::kReadout,
                                    plane_bit::kSampled,
                                    plane_bit::kSampled,
                                    0,
                                    RandomScope::kPerExposure,
                                    "Jannsen2024",
                                    ImageRole::kNone,
                                    PixelSet::kAll,
                                    true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
