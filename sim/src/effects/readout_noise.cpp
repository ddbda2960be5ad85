#include "effects/readout_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "astroid/core/readout_nodes.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

namespace {

bool differs_between_nodes(const NodeSettings& nodes) {
  return std::ranges::any_of(nodes.noise_factor, [](double factor) { return factor != 1.0; });
}

}  // namespace

EffectNeed ReadoutNoise::is_needed(const SceneSummary& scene) const {
  double rms = scene.mission->ccd.readout_noise.value();
  for (const double factor : scene.mission->ccd.nodes.noise_factor)
    rms = std::max(rms, factor * scene.mission->ccd.readout_noise.value());
  if (rms <= 0.0) return {false, "the readout is noiseless (readout noise 0)", 0.0, 0.0};
  const double variance = rms * rms;
  // The quantisation error of an image with less noise than this depends on the signal, so noise may not be left out
  // there.
  const double rest = scene.faintest_target_electrons + scene.pixel_noise_variance - variance;
  const double ratio = rest > 0.0 ? variance * scene.aperture_pixels / rest : 1.0;
  return {ratio > kVarianceTolerance,
          fmt::format("{:.4g} e- rms per pixel; all other variance of the faintest target is at least {:.4g} e-²", rms,
                      rest),
          0.0, ratio};
}

void ReadoutNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  const double rms = ccd.readout_noise.value();
  const std::span<double> sampled = state.sampled.pixels(strip);
  if (!differs_between_nodes(ccd.nodes)) {
    add_pixel_normals(context.stream, noise_of(strip, state.number), rms, sampled);
    return;
  }
  const ReadoutNodes nodes(context.scene.detector(), ccd.nodes.count);
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const Rectangle& area = strip.areas[a];
    std::size_t begin = strip.area_begins[a] - strip.begin;
    for (int y = area.y0; y < area.y1(); ++y)
      for_each_node(nodes, y, area.x0, area.x1(), [&](int node, int x0, int x1) {
        const std::array part{Rectangle{x0, y, x1 - x0, 1}};
        const double factor = ccd.nodes.noise_factor[static_cast<std::size_t>(node)];
        add_pixel_normals(context.stream, {.areas = part, .exposure = static_cast<std::uint32_t>(state.number)},
                          factor * rms, sampled.subspan(begin, part[0].size()));
        begin += part[0].size();
      });
  }
}

}  // namespace astroid
