#include "effects/dark_current.hpp"

#include <algorithm>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

namespace {
Electrons dark_electrons(const Mission& mission) {
  return mission.ccd.dark_current * mission.simulation.exposure_time;
}
}  // namespace

EffectNeed DarkCurrent::is_needed(const SceneSummary& scene) const {
  return background_need(scene, dark_electrons(*scene.mission).value(), "dark current");
}

void DarkCurrent::prepare(CameraState& camera, const Scene& scene, const RandomStream& stream) const {
  const double level = dark_electrons(scene.mission()).value();
  const double dsnu = scene.mission().ccd.dsnu;
  camera.dark = Plane<float, unit::ExpectedElectrons>(scene.layout());
  std::vector<double> normals;
  for (std::size_t r = 0; r < scene.layout()->regions().size(); ++r) {
    const Rectangle& area = scene.layout()->regions()[r];
    normals.resize(static_cast<std::size_t>(area.nx));
    for (int y = area.y0; y < area.y1(); ++y) {
      normal_row(stream, {.x0 = area.x0, .y = y}, normals);
      const std::span<float> row = camera.dark.view(r).row(y);
      for (std::size_t i = 0; i < row.size(); ++i)
        row[i] = static_cast<float>(level * std::max(0.0, 1.0 + dsnu * normals[i]));
    }
  }
}

void DarkCurrent::apply(ExposureState& state, const EffectContext& context) const {
  const std::span<double> pixels = state.expected.pixels();
  const std::span<const float> dark = context.camera.dark.pixels();
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] += static_cast<double>(dark[i]);
}

}  // namespace astroid
