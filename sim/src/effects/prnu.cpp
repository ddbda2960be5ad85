#include "effects/prnu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed Prnu::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.prnu;
  if (rms <= 0.0) return {false, "the pixel response is uniform (PRNU 0)", 0.0, 0.0};
  // The largest error of a flux is that of a star whose light is all in one pixel.
  const double bias = rms * scene.brightest_target_electrons;
  const double gradient = rms * scene.psf.gradient * scene.attitude_rms_px;
  const double flux = scene.brightest_target_electrons;
  const double variance_ratio = flux > 0.0 ? gradient * gradient / scene.relative_variance_in_bin(flux) : 0.0;
  const bool needed = rms > scene.accuracy || variance_ratio > kVarianceTolerance;
  return {needed,
          fmt::format("{:.3g} % rms changes each flux by up to {:.3g} ppm, the accuracy asked for is {:.3g} ppm",
                      100.0 * rms, 1e6 * rms, 1e6 * scene.accuracy),
          bias, variance_ratio};
}

void Prnu::prepare(CameraState& camera, const Scene& scene, const RandomStream& stream) const {
  const double rms = scene.mission().ccd.prnu;
  camera.prnu = Plane<float, unit::Relative>(scene.layout());
  std::vector<double> normals;
  for (std::size_t r = 0; r < scene.layout()->regions().size(); ++r) {
    const Rectangle& area = scene.layout()->regions()[r];
    normals.resize(static_cast<std::size_t>(area.nx));
    for (int y = area.y0; y < area.y1(); ++y) {
      normal_row(stream, {.x0 = area.x0, .y = y}, normals);
      const std::span<float> row = camera.prnu.view(r).row(y);
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<float>(std::max(0.0, 1.0 + rms * normals[i]));
    }
  }
}

void Prnu::apply(ExposureState& state, const EffectContext& context) const {
  const std::span<double> pixels = state.expected.pixels();
  const std::span<const float> response = context.camera.prnu.pixels();
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] *= static_cast<double>(response[i]);
}

}  // namespace astroid
