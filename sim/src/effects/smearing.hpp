// Smearing of the image along the columns while it is read or moved: open shutter and frame transfer.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Adds to every row of a column, overscan included, the light that falls on it while it is clocked through the column:
/// the frame is read without a shutter, again and again, so each packet of charge passes every row once between two
/// exposures, before or after its own. Prescan pixels never lie in a column and get none. With four nodes each half of
/// a column is read towards its own register, and is a column of its own.
/// @source F30
class OpenShutterSmearing final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "open-shutter-smearing",
                                    .id = StreamId{70},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kStars | plane_bit::kAttitude | plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Jannsen2024",
                                    .role = ImageRole::kLight,
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// The same for a frame that is moved fast into a dark store: a row passes those below it in the transfer after the
/// exposure, and has passed those above it in the one before, which may take another time (or none, where the charge is
/// dumped). Overscan rows pass all rows after the exposure.
/// @source F80
class FrameTransferSmearing final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "frame-transfer-smearing",
                                    .id = StreamId{71},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kStars | plane_bit::kAttitude | plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = "Ruyten1999",
                                    .role = ImageRole::kLight,
                                    .pixels = PixelSet::kAll};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
