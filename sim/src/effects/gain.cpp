#include "effects/gain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/readout_nodes.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/slow_drift.hpp"

namespace astroid {

namespace {

bool differs_between_nodes(const NodeSettings& nodes) {
  return std::ranges::any_of(nodes.gain_factor, [](double factor) { return factor != 1.0; });
}

}  // namespace

EffectNeed GainEffect::is_needed(const SceneSummary& scene) const {
  const CcdSettings& ccd = scene.mission->ccd;
  std::string why = fmt::format("electrons become ADU at {:.6g} e-/ADU", ccd.gain.value());
  if (differs_between_nodes(ccd.nodes)) {
    const auto [low, high] = std::ranges::minmax(ccd.nodes.gain_factor);
    why += fmt::format(", by a factor of {:.6g} to {:.6g} from node to node", low, high);
  }
  if (ccd.electronics.gain_drift > 0.0)
    why += fmt::format(", and {:.3g} ppm more or less as the electronics drift", 1e6 * ccd.electronics.gain_drift);
  return {true, std::move(why), 0.0, 0.0};
}

void GainEffect::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  const double gain =
      ccd.gain.value() *
      (1.0 + ccd.electronics.gain_drift * slow_drift(context.scene.mission_time(state.exposure), ccd.electronics));
  const std::span<const double> sampled = state.sampled.pixels(strip);
  const std::span<double> analog = state.analog.pixels(strip);
  if (!differs_between_nodes(ccd.nodes)) {
    scale_values(sampled, 1.0 / gain, analog);
    return;
  }
  const ReadoutNodes nodes(context.scene.detector(), ccd.nodes.count);
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const Rectangle& area = strip.areas[a];
    std::size_t begin = strip.area_begins[a] - strip.begin;
    for (int y = area.y0; y < area.y1(); ++y)
      for_each_node(nodes, y, area.x0, area.x1(), [&](int node, int x0, int x1) {
        const auto count = static_cast<std::size_t>(x1 - x0);
        const double factor = ccd.nodes.gain_factor[static_cast<std::size_t>(node)];
        scale_values(sampled.subspan(begin, count), 1.0 / (gain * factor), analog.subspan(begin, count));
        begin += count;
      });
  }
}

}  // namespace astroid
