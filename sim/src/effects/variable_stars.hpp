// Stars whose flux varies.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds variable stars with their flux averaged over the exposure; the effect `stars` leaves them to this one.
///
/// Flux and motion within an exposure are taken as independent of each other.
class VariableStars final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"variable-stars",        StreamId{26},
                                    EffectLevel::kOptics,    plane_bit::kStars | plane_bit::kAttitude,
                                    plane_bit::kExpected,    0,
                                    RandomScope::kNone,      "",
                                    ImageRole::kVaryingLight};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
