// Cosmic rays.
#pragma once

#include "astroid/sim/cosmic_rays.hpp"
#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds the charge of particles that hit the detector from one readout to the next (F38), after photon noise: its own
/// fluctuation is in the model. The pixels are flagged, for the truth.
class CosmicRays final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "cosmic-rays",
                                    .id = StreamId{51},
                                    .level = EffectLevel::kPixelSample,
                                    .reads = plane_bit::kSampled,
                                    .writes = plane_bit::kSampled | plane_bit::kFlags,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "Jannsen2024",
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// The particles of one of `reads` equal parts of a cycle.
CosmicRayModel cosmic_ray_model(const Mission& mission, int reads);

}  // namespace astroid
