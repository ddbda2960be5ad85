#include "effects/bias_drift.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/readout_nodes.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/pixel_pattern.hpp"
#include "effects/slow_drift.hpp"

namespace astroid {

EffectNeed BiasDrift::is_needed(const SceneSummary& scene) const {
  const double amplitude = scene.mission->ccd.electronics.bias_drift;
  if (amplitude <= 0.0) return {false, "the bias does not drift", 0.0, 0.0};
  const double bias = amplitude * scene.mission->ccd.gain.value() * scene.aperture_pixels;
  const double tolerance = scene.tightest_tolerance();
  return {bias > tolerance,
          fmt::format("{:.3g} ADU more or less are {:.4g} e- in {:.3g} px; the tightest flux tolerance is {:.3g} e-",
                      amplitude, bias, scene.aperture_pixels, tolerance),
          bias, 0.0};
}

void BiasDrift::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const ElectronicsSettings& electronics = context.scene.mission().ccd.electronics;
  const double drift = slow_drift(context.scene.mission_time(state.exposure), electronics);
  add_constant(state.analog.pixels(strip), electronics.bias_drift * drift);
}

EffectNeed RowOffset::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.electronics.row_offset;
  if (rms <= 0.0) return {false, "rows have no offsets of their own", 0.0, 0.0};
  const double electrons = rms * scene.mission->ccd.gain.value();
  // In a square of n pixels, sqrt(n) rows each carry sqrt(n) times their offset.
  const double pixels = scene.aperture_pixels;
  const double variance = electrons * electrons * pixels * det::sqrt(pixels);
  const double rest = scene.faintest_target_electrons + scene.pixel_noise_variance;
  const double ratio = rest > 0.0 ? variance / rest : 1.0;
  return {ratio > kVarianceTolerance,
          fmt::format("{:.4g} e- rms a row add {:.4g} e-² to {:.3g} px; the faintest target has {:.4g} e-² or more",
                      electrons, variance, pixels, rest),
          0.0, ratio};
}

void RowOffset::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  const ReadoutNodes nodes(context.scene.detector(), ccd.nodes.count);
  std::vector<float> normals;
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const Rectangle& area = strip.areas[a];
    // The draw of a row is that of its pixel (node, row), the same for whatever part of the row is computed.
    const std::array draws{Rectangle{0, area.y0, kMostNodes, area.ny}};
    normals.resize(draws[0].size());
    pixel_normals(context.stream, {.areas = draws, .exposure = static_cast<std::uint32_t>(state.number)}, normals);
    const auto view = state.analog.view(strip, a);
    for (int y = area.y0; y < area.y1(); ++y) {
      const std::span<const float> of_row = std::span(normals).subspan(
          static_cast<std::size_t>(y - area.y0) * static_cast<std::size_t>(kMostNodes), kMostNodes);
      for_each_node(nodes, y, area.x0, area.x1(), [&](int node, int x0, int x1) {
        const double normal = static_cast<double>(of_row[static_cast<std::size_t>(node)]);
        add_constant(view.row(y).subspan(static_cast<std::size_t>(x0 - area.x0), static_cast<std::size_t>(x1 - x0)),
                     ccd.electronics.row_offset * normal);
      });
    }
  }
}

}  // namespace astroid
