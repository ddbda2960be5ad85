// Throughput of the optics: what they pass, less every year.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Sets the throughput of the exposure's conditions, by which stars, ghosts and sky are multiplied.
///
/// Linear from the beginning to the end of life. An epoch shares the value at its middle.
class ThroughputEffect final : public Effect {
 public:
  static constexpr EffectSpec kSpec{"throughput",       StreamId{40}, EffectLevel::kOptics, 0, 0, 0,
                                    RandomScope::kNone, "Jannsen2024"};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
