#include "effects/ramp_reads.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "astroid/core/detector_noise.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed RampReads::is_needed(const SceneSummary& scene) const {
  const int reads = scene.mission->cmos.reads;
  if (reads <= 1) return {false, "each exposure is read once", 0.0, 0.0};
  return {true, fmt::format("{} reads from the beginning to the end of each exposure, without a reset between", reads),
          0.0, 0.0};
}

void RampReads::prepare(CameraState& camera, const PrepareContext& context) const {
  const Mission& mission = context.scene.mission();
  if (mission.cmos.reads <= 1) return;
  camera.cmos.ladder =
      std::make_shared<const RampLadder>(mission.cmos.ramp_fit, mission.cmos.reads, read_variance(mission));
}

void RampReads::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  if (context.camera.cmos.ladder == nullptr) return;  // a single read is what it is
  const RampLadder& ladder = *context.camera.cmos.ladder;
  if (state.read == 0) {
    const std::span<const double> expected = state.expectation(strip);
    const std::span<std::uint8_t> levels = state.ramps.level.pixels(strip);
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = ladder.level(expected[i]);
  }
  const Frame& frame = state.computed();
  take_ramp_read(ladder, state.read, frame.pixels.pixels().subspan(strip.begin, strip.size()),
                 frame.flags.pixels().subspan(strip.begin, strip.size()), state.ramps.pixels(strip));
}

}  // namespace astroid
