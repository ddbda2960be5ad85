#include "effects/cross_talk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

#include "astroid/core/readout_nodes.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {

struct Mirror {
  bool x, y;
};

/// Where the other nodes read at the same time.
std::vector<Mirror> mirrors_of(const Scene& scene) {
  switch (ReadoutNodes(scene.detector(), scene.mission().ccd.nodes.count).count()) {
    case 2:
      return {{true, false}};
    case 4:
      return {{true, false}, {false, true}, {true, true}};
    default:
      return {};
  }
}

Rectangle mirrored(const Rectangle& r, const Rectangle& detector, const Mirror& mirror) {
  return {mirror.x ? detector.x0 + detector.x1() - r.x1() : r.x0,
          mirror.y ? detector.y0 + detector.y1() - r.y1() : r.y0, r.nx, r.ny};
}

bool holds(const Rectangle& outer, const Rectangle& inner) {
  return intersect(outer, inner) == inner;
}

}  // namespace

EffectNeed CrossTalk::is_needed(const SceneSummary& scene) const {
  const NodeSettings& nodes = scene.mission->ccd.nodes;
  if (nodes.count < 2) return {false, "the detector is read through one node", 0.0, 0.0};
  if (nodes.cross_talk == 0.0) return {false, "nodes do not disturb each other (cross-talk 0)", 0.0, 0.0};
  // A ghost of the brightest star and of the background, from each of the other nodes.
  const double ghost =
      std::abs(nodes.cross_talk) * (scene.brightest_electrons + scene.background * scene.aperture_pixels);
  const double bias = ghost * (nodes.count - 1);
  return {bias > scene.tightest_tolerance(),
          fmt::format("a ghost of the brightest star ({}) holds {:.4g} e-; the tightest flux tolerance is {:.3g} e-",
                      scene.brightest_id, bias, scene.tightest_tolerance()),
          bias, nodes.cross_talk * nodes.cross_talk};
}

void CrossTalk::support(const Scene& scene, std::vector<Rectangle>& regions) const {
  const std::size_t asked = regions.size();
  for (std::size_t r = 0; r < asked; ++r)
    for (const Mirror& mirror : mirrors_of(scene)) {
      const Rectangle other = mirrored(regions[r], scene.detector(), mirror);
      if (std::ranges::none_of(regions, [&](const Rectangle& region) { return holds(region, other); }))
        regions.push_back(other);
    }
}

void CrossTalk::prepare(CameraState& camera, const PrepareContext& context) const {
  // Effects before this one may have made the regions larger, with margins that are not right, but left them in the
  // order in which support() put them.
  const Scene& scene = context.scene;
  const bool whole = camera.layout->regions().front() == scene.detector();
  const std::span<const Rectangle> delivered = scene.layout()->exposed_regions();
  std::vector<Rectangle> asked(delivered.begin(), delivered.end());
  support(scene, asked);
  for (const Rectangle& area : delivered)
    for (const Mirror& mirror : mirrors_of(scene)) {
      const Rectangle other = mirrored(area, scene.detector(), mirror);
      const auto found = std::ranges::find_if(asked, [&](const Rectangle& region) { return holds(region, other); });
      const std::size_t from = whole ? 0 : static_cast<std::size_t>(found - asked.begin());
      ASTROID_CHECK_EQ(holds(camera.layout->exposed_regions()[from], other), true);
      camera.cross_talk_from.push_back(from);
    }
}

void CrossTalk::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const double share = context.scene.mission().ccd.nodes.cross_talk;
  const Rectangle detector = context.scene.detector();
  const std::vector<Mirror> mirrors = mirrors_of(context.scene);
  const std::span<double> pixels = state.analog.pixels(strip);
  // Every node hears the others as they were.
  state.scratch.assign(pixels.begin(), pixels.end());
  // Nothing after this depends on other pixels than its own, so the delivered ones are enough.
  const std::span<const Rectangle> delivered = context.scene.layout()->exposed_regions();
  const bool whole = strip.areas.front() == detector;
  auto from = context.camera.cross_talk_from.begin();
  for (std::size_t r = 0; r < delivered.size(); ++r) {
    const Rectangle& area = delivered[r];
    const auto view = state.analog.view(strip, whole ? 0 : r);
    for (const Mirror& mirror : mirrors) {
      const Rectangle& source = strip.areas[*from];
      const std::size_t begin = strip.area_begins[*from] - strip.begin;
      ++from;
      for (int y = area.y0; y < area.y1(); ++y) {
        const int y_other = mirror.y ? detector.y0 + detector.y1() - 1 - y : y;
        const double* row = state.scratch.data() + begin +
                            static_cast<std::size_t>(y_other - source.y0) * static_cast<std::size_t>(source.nx);
        for (int x = area.x0; x < area.x1(); ++x) {
          const int x_other = mirror.x ? detector.x0 + detector.x1() - 1 - x : x;
          view.at(x, y) += share * row[x_other - source.x0];
        }
      }
    }
  }
}

}  // namespace astroid
