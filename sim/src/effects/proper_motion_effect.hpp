// Proper motion.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Stands for what the scene did when it was built: stars are where they are in the middle of the run.
class ProperMotionEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"proper-motion",    StreamId{23},      EffectLevel::kCatalogue,
                                    plane_bit::kStars,  plane_bit::kStars, 0,
                                    RandomScope::kNone, "ESA1997"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
