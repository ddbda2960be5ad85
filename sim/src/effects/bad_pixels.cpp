#include "effects/bad_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
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

/// Calls visit(place in the buffer, entry) for the entries of a list that lie on exposed pixels.
template <class Entry, class Visit>
void for_each_listed(const PixelLayout& layout, const std::vector<Entry>& list, Visit&& visit) {
  for (std::size_t r = 0; r < layout.exposed_regions().size(); ++r) {
    const Rectangle& area = layout.regions()[r];
    for (const Entry& entry : list) {
      if (!area.contains(entry.x, entry.y)) continue;
      const std::size_t within = static_cast<std::size_t>(entry.y - area.y0) * static_cast<std::size_t>(area.nx) +
                                 static_cast<std::size_t>(entry.x - area.x0);
      visit(static_cast<std::uint32_t>(layout.offset(r) + within), entry);
    }
  }
}

double pixels_on(const Mission& mission, double fraction) {
  return fraction * mission.ccd.columns * mission.ccd.rows;
}

/// How many there are, in words.
std::string how_many(const char* kind, double drawn, std::size_t listed) {
  if (listed == 0) return fmt::format("{:.4g} {} pixels are expected on the detector", drawn, kind);
  const std::string known = fmt::format("{} {} pixels are listed", listed, kind);
  return drawn > 0.0 ? fmt::format("{} and {:.4g} more expected", known, drawn) : known;
}

}  // namespace

EffectNeed DeadPixels::is_needed(const SceneSummary& scene) const {
  const double fraction = scene.mission->ccd.bad_pixels.dead;
  if (fraction <= 0.0 && scene.listed_dead == 0) return {false, "no pixel is dead", 0.0, 0.0};
  const double lost = scene.psf.peak_fraction * scene.brightest_target_electrons;
  return {true,
          fmt::format("{}; one takes up to {:.4g} e- from a target",
                      how_many("dead", pixels_on(*scene.mission, fraction), scene.listed_dead), lost),
          lost, 1.0};
}

void DeadPixels::prepare(CameraState& camera, const PrepareContext& context) const {
  std::vector<std::uint32_t>& dead = camera.dead_pixels;
  dead = drawn_pixels(context.stream, *camera.layout, context.scene.mission().ccd.bad_pixels.dead);
  for_each_listed(*camera.layout, context.scene.bad_pixels().dead,
                  [&](std::uint32_t place, const DeadPixel&) { dead.push_back(place); });
  std::ranges::sort(dead);
  dead.erase(std::unique(dead.begin(), dead.end()), dead.end());
}

void DeadPixels::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const std::span<double> expected = state.expected.pixels(strip);
  for (const std::uint32_t pixel : within(context.camera.dead_pixels, strip)) expected[pixel - strip.begin] = 0.0;
}

EffectNeed HotPixels::is_needed(const SceneSummary& scene) const {
  const BadPixelSettings& bad = scene.mission->ccd.bad_pixels;
  const double drawn = bad.hot > 0.0 ? (bad.hot_current * scene.mission->simulation.exposure_time).value() : 0.0;
  const double level = std::max(drawn, scene.hottest);
  if (level <= 0.0) return {false, "no pixel is hot", 0.0, 0.0};
  return {true,
          fmt::format("{}; each adds {}{:.4g} e- per exposure",
                      how_many("hot", pixels_on(*scene.mission, bad.hot), scene.listed_hot),
                      scene.listed_hot > 0 ? "up to " : "", level),
          level, 1.0};
}

void HotPixels::prepare(CameraState& camera, const PrepareContext& context) const {
  const Mission& mission = context.scene.mission();
  const Seconds exposure = mission.simulation.exposure_time;
  std::map<std::uint32_t, double> electrons;
  for (const std::uint32_t place : drawn_pixels(context.stream, *camera.layout, mission.ccd.bad_pixels.hot))
    electrons[place] = (mission.ccd.bad_pixels.hot_current * exposure).value();
  for_each_listed(*camera.layout, context.scene.bad_pixels().hot, [&](std::uint32_t place, const HotPixel& hot) {
    electrons[place] += (hot.current * exposure).value();
  });
  for (const auto& [place, level] : electrons) {
    camera.hot_pixels.push_back(place);
    camera.hot_electrons.push_back(level);
  }
}

void HotPixels::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const std::span<double> expected = state.expected.pixels(strip);
  const CameraState& camera = context.camera;
  const std::span<const std::uint32_t> hot = within(camera.hot_pixels, strip);
  const double* level = camera.hot_electrons.data() + (hot.data() - camera.hot_pixels.data());
  for (const std::uint32_t pixel : hot) expected[pixel - strip.begin] += *level++;
}

EffectNeed BadPixelMap::is_needed(const SceneSummary& scene) const {
  const BadPixelSettings& bad = scene.mission->ccd.bad_pixels;
  const double fraction = bad.dead + bad.hot;
  const std::size_t listed = scene.listed_dead + scene.listed_hot;
  if (fraction <= 0.0 && listed == 0) return {false, "every pixel works", 0.0, 0.0};
  return {true, how_many("bad", pixels_on(*scene.mission, fraction), listed), 0.0, 0.0};
}

void BadPixelMap::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const std::span<std::uint8_t> flags = state.computed().flags.pixels();
  for (const auto* pixels : {&context.camera.dead_pixels, &context.camera.hot_pixels})
    for (const std::uint32_t pixel : within(*pixels, strip)) flags[pixel] |= pixel_flag::kBad;
}

}  // namespace astroid
