// Breathing: the width of the PSF follows the temperature.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Variance of the blur at a time since the start of the run, px²: amplitude² (1 - cos 2 pi (t / period + phase)) / 2.
double breathing_variance(const BreathingSettings& settings, Seconds time);

/// Sets the PSF's additional variance of the exposure's conditions. An epoch shares the value at its middle.
class Breathing final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"breathing", StreamId{41},       EffectLevel::kOptics, 0, 0,
                                    0,           RandomScope::kNone, "Boerner2024"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
