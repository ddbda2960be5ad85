// Zodiacal light and unresolved stars.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the sky by direction and season, at the middle of each exposure, bilinear between the corners of the detector.
class ZodiacalSky final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"zodiacal-sky",       StreamId{24},         EffectLevel::kSky,
                                    plane_bit::kExpected, plane_bit::kExpected, 0,
                                    RandomScope::kNone,   "Leinert1998",        ImageRole::kVaryingLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
