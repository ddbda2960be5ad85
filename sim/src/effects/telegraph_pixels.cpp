#include "effects/telegraph_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

namespace {

constexpr std::uint16_t kChoiceRead = 1;  // draws with read 0 are those of the process

TelegraphProcess process_of(const Mission& mission) {
  const CmosSettings& cmos = mission.cmos;
  return TelegraphProcess::of_times({.low = cmos.telegraph_low.value(), .high = cmos.telegraph_high.value()},
                                    mission.simulation.cycle.value());
}

}  // namespace

EffectNeed TelegraphPixels::is_needed(const SceneSummary& scene) const {
  const CmosSettings& cmos = scene.mission->cmos;
  const double jump = (cmos.telegraph_current * scene.mission->simulation.exposure_time).value();
  if (!(cmos.telegraph_fraction > 0.0 && jump > 0.0)) return {false, "no pixel jumps between two states", 0.0, 0.0};
  // A star over such a pixel sees all of it, and of several if there are many.
  const double expected = cmos.telegraph_fraction * scene.aperture_pixels;
  constexpr double kWorst = 3.0;  // sigma: of some hundred stars one has as many
  const double bias = jump * std::max(1.0, expected + kWorst * det::sqrt(expected));
  return {bias > scene.tightest_tolerance(),
          fmt::format("{:.3g} % of the pixels jump by {:.4g} e- per exposure, up to {:.4g} e- in an aperture; the "
                      "tightest flux tolerance is {:.3g} e-",
                      100.0 * cmos.telegraph_fraction, jump, bias, scene.tightest_tolerance()),
          bias, 0.0};
}

void TelegraphPixels::prepare(CameraState& camera, const PrepareContext& context) const {
  const double fraction = context.scene.mission().cmos.telegraph_fraction;
  std::vector<double> uniforms;
  for (const Strip& strip : camera.strips) {
    if (!strip.exposed) continue;
    uniforms.resize(strip.size());
    PixelPlaces places = noise_of(strip, 0);
    places.read = kChoiceRead;
    pixel_uniforms(context.stream, places, uniforms);
    std::size_t at = 0;
    for (const Rectangle& area : strip.areas) {
      for (int y = area.y0; y < area.y1(); ++y) {
        for (int x = area.x0; x < area.x1(); ++x, ++at) {
          if (!(uniforms[at] < fraction)) continue;
          camera.cmos.telegraph.push_back({x, y});
          camera.cmos.telegraph_at.push_back(strip.begin + at);
        }
      }
    }
  }
}

void TelegraphPixels::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  const TelegraphProcess process = process_of(mission);
  const double jump = (mission.cmos.telegraph_current * mission.simulation.exposure_time).value();
  const std::vector<std::size_t>& at = context.camera.cmos.telegraph_at;
  const std::span<double> expected = state.expected.pixels(strip);
  const auto first = static_cast<std::size_t>(std::ranges::lower_bound(at, strip.begin) - at.begin());
  for (std::size_t i = first; i < at.size() && at[i] < strip.end; ++i)
    if (telegraph_is_high(context.stream, context.camera.cmos.telegraph[i], process,
                          static_cast<std::uint32_t>(state.number)))
      expected[at[i] - strip.begin] += jump;
}

}  // namespace astroid
