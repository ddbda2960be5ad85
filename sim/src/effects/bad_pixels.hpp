// Pixels that do not work: dead ones, hot ones, and the map of both.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Pixels that see no light, at places drawn once for a camera.
class DeadPixels final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "dead-pixels",
                                    .id = StreamId{74},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kStatic,
                                    .source = "",
                                    .role = ImageRole::kResponse};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// Pixels with a large dark current, at places drawn once for a camera.
class HotPixels final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "hot-pixels",
                                    .id = StreamId{75},
                                    .level = EffectLevel::kPixelMean,
                                    .reads = plane_bit::kExpected,
                                    .writes = plane_bit::kExpected,
                                    .halo_px = 0,
                                    .random = RandomScope::kStatic,
                                    .source = "",
                                    .role = ImageRole::kOffset};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void prepare(CameraState& camera, const PrepareContext& context) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

/// Flags dead and hot pixels in every exposure, as the map of bad pixels that a ground segment has.
class BadPixelMap final : public Effect {
 public:
  static constexpr EffectSpec kSpec{.name = "bad-pixel-map",
                                    .id = StreamId{76},
                                    .level = EffectLevel::kReadout,
                                    .reads = plane_bit::kFlags,
                                    .writes = plane_bit::kFlags,
                                    .halo_px = 0,
                                    .random = RandomScope::kNone,
                                    .source = ""};
  [[nodiscard]] const EffectSpec& spec() const override { return kSpec; }
  [[nodiscard]] EffectNeed is_needed(const SceneSummary& scene) const override;
  void apply(ExposureState& state, const EffectContext& context, const Strip& strip) const override;
};

}  // namespace astroid
