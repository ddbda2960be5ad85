// Readout noise of single pixels.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds normal noise to each read. The rms differs from pixel to pixel by a fixed log-normal factor whose root mean
/// square is 1: the stated readout noise is that of all pixels together. The draws of a pixel are those of the CCD's
/// readout noise.
class PixelReadoutNoise final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "readout-noise",
                                    .id = StreamId{9},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kAnalog,
                                    .writes = plane_bit::kAnalog,
                                    .halo_px = 0,
                                    .random = RandomScope::kPerExposure,
                                    .source = "",
                                    .pixels = PixelSet::kAll,
                                    .per_read = true};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
