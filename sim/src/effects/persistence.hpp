// Persistence of a CMOS detector.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Takes from each pixel what its traps hold at the end of the exposure, and adds what they release of the charge of
/// earlier ones. Their images are those expected: Poisson charge that is split stays Poisson and independent. What
/// particles left in the traps is left out, and what lies above the full well, which no trap sees.
/// @source F115
class Persistence final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "persistence",
                                    .id = StreamId{99},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Smith2008",
                                    .role = ImageRole::kMemory};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// The kernel of a mission, to an accuracy that does not matter.
PersistenceKernel persistence_kernel(const Mission& mission);

}  // namespace astroid
