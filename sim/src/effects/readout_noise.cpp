#include "effects/readout_noise.hpp"

#include <fmt/format.h>

#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed ReadoutNoise::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.readout_noise.value();
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

void ReadoutNoise::apply(ExposureState& state, const EffectContext& context) const {
  const double rms = context.scene.mission().ccd.readout_noise.value();
  std::vector<double>& normals = state.scratch;
  for (std::size_t r = 0; r < state.sampled.layout().regions().size(); ++r) {
    const auto electrons = state.sampled.view(r);
    const Rectangle& area = electrons.area();
    if (normals.size() < static_cast<std::size_t>(area.nx)) normals.resize(static_cast<std::size_t>(area.nx));
    const std::span<double> noise(normals.data(), static_cast<std::size_t>(area.nx));
    for (int y = area.y0; y < area.y1(); ++y) {
      normal_row(context.stream, {.x0 = area.x0, .y = y, .exposure = static_cast<std::uint32_t>(state.exposure)},
                 noise);
      const std::span<double> row = electrons.row(y);
      for (std::size_t i = 0; i < row.size(); ++i) row[i] += rms * noise[i];
    }
  }
}

}  // namespace astroid
