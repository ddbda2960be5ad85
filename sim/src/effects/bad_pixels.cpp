#include "effects/bad_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/pixel_noise.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

namespace {

/// The pixels of a layout whose uniform is below a fraction, by their place in the buffer, in rising order.
std::vector<std::uint32_t> drawn_pixels(const RandomStream& stream, const PixelLayout& layout, double fraction) {
  constexpr std::size_t kAtOnce = 8192;
  std::vector<std::uint32_t> pixels;
  std::vector<double> uniforms;
  for (const Strip& strip : make_strips(layout, kAtOnce)) {
    if (!strip.exposed) continue;
    uniforms.resize(strip.size());
    pixel_uniforms(stream, noise_of(strip, 0), uniforms);
    for (std::size_t i = 0; i < uniforms.size(); ++i)
      if (uniforms[i] < fraction) pixels.push_back(static_cast<std::uint32_t>(strip.begin + i));
  }
  return pixels;
}

/// Those that lie in a strip.
std::span<const std::uint32_t> within(std::span<const std::uint32_t> pixels, const Strip& strip) {
  const auto first = std::ranges::lower_bound(pixels, static_cast<std::uint32_t>(strip.begin));
  const auto last = std::ranges::lower_bound(first, pixels.end(), static_cast<std::uint32_t>(strip.end));
  return {first, last};
}

double pixels_on(const Mission& mission, double fraction) {
  return fraction * mission.ccd.columns * mission.ccd.rows;
}

}  // namespace

EffectNeed DeadPixels::is_needed(const SceneSummary& scene) const {
  const double fraction = scene.mission->ccd.bad_pixels.dead;
  if (fraction <= 0.0) return {false, "no pixel is dead", 0.0, 0.0};
  const double lost = scene.psf.peak_fraction * scene.brightest_target_electrons;
  return {true,
          fmt::format("{:.4g} dead pixels are expected on the detector; one takes up to {:.4g} e- from a target",
                      pixels_on(*scene.mission, fraction), lost),
          lost, 1.0};
}

void DeadPixels::prepare(CameraState& camera, const PrepareContext& context) const {
  camera.dead_pixels = drawn_pixels(context.stream, *camera.layout, context.scene.mission().ccd.bad_pixels.dead);
}

void DeadPixels::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const std::span<double> expected = state.expected.pixels(strip);
  for (const std::uint32_t pixel : within(context.camera.dead_pixels, strip)) expected[pixel - strip.begin] = 0.0;
}

EffectNeed HotPixels::is_needed(const SceneSummary& scene) const {
  const BadPixelSettings& bad = scene.mission->ccd.bad_pixels;
  const double level = (bad.hot_current * scene.mission->simulation.exposure_time).value();
  if (bad.hot <= 0.0 || level <= 0.0) return {false, "no pixel is hot", 0.0, 0.0};
  return {true,
          fmt::format("{:.4g} hot pixels are expected on the detector; each adds {:.4g} e- per exposure",
                      pixels_on(*scene.mission, bad.hot), level),
          level, 1.0};
}

void HotPixels::prepare(CameraState& camera, const PrepareContext& context) const {
  camera.hot_pixels = drawn_pixels(context.stream, *camera.layout, context.scene.mission().ccd.bad_pixels.hot);
}

void HotPixels::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  const double level = (mission.ccd.bad_pixels.hot_current * mission.simulation.exposure_time).value();
  const std::span<double> expected = state.expected.pixels(strip);
  for (const std::uint32_t pixel : within(context.camera.hot_pixels, strip)) expected[pixel - strip.begin] += level;
}

EffectNeed BadPixelMap::is_needed(const SceneSummary& scene) const {
  const BadPixelSettings& bad = scene.mission->ccd.bad_pixels;
  const double fraction = bad.dead + bad.hot;
  if (fraction <= 0.0) return {false, "every pixel works", 0.0, 0.0};
  return {true, fmt::format("{:.4g} bad pixels are expected on the detector", pixels_on(*scene.mission, fraction)), 0.0,
          0.0};
}

void BadPixelMap::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const std::span<std::uint8_t> flags = state.computed().flags.pixels();
  for (const auto* pixels : {&context.camera.dead_pixels, &context.camera.hot_pixels})
    for (const std::uint32_t pixel : within(*pixels, strip)) flags[pixel] |= pixel_flag::kBad;
}

}  // namespace astroid
