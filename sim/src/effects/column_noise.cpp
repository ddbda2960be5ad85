#include "effects/column_noise.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/math.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

namespace {

// Numbers of columns stand in row 0 of the stream, those of rows in column 0.
constexpr std::uint16_t kColumnDraw = 0;
constexpr std::uint16_t kRowDraw = 1;

/// One normal for each column or each row of an area.
std::span<const float> shared_normals(const EffectContext& context, ExposureState& state, const Rectangle& line,
                                      std::uint16_t draw) {
  state.normals.resize(line.size());
  pixel_normals(context.stream,
                {.areas = {&line, 1},
                 .exposure = static_cast<std::uint32_t>(state.number),
                 .read = static_cast<std::uint16_t>(state.read),
                 .draw = draw},
                state.normals);
  return state.normals;
}

}  // namespace

EffectNeed ColumnNoise::is_needed(const SceneSummary& scene) const {
  const double columns = scene.mission->cmos.column_noise.value();
  const double rows = scene.mission->cmos.row_noise.value();
  if (columns <= 0.0 && rows <= 0.0)
    return {false, "columns and rows share no noise (column and row noise 0)", 0.0, 0.0};
  // A square aperture of A pixels has sqrt(A) columns of sqrt(A) pixels: A^(3/2) of the variance of a column.
  const double factor = fitted_readout_factor(*scene.mission);
  const double rms = factor * det::sqrt((columns * columns + rows * rows) * det::sqrt(scene.aperture_pixels));
  return noise_need(scene, rms, "e- rms per pixel, as columns and rows add up in an aperture");
}

void ColumnNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  const double per_gain = 1.0 / mission.ccd.gain.value();
  const double columns = mission.cmos.column_noise.value() * per_gain;
  const double rows = mission.cmos.row_noise.value() * per_gain;
  for (std::size_t r = 0; r < strip.areas.size(); ++r) {
    const auto analog = state.analog.view(strip, r);
    const Rectangle& area = analog.area();
    if (columns > 0.0) {
      const auto normals = shared_normals(context, state, {area.x0, 0, area.nx, 1}, kColumnDraw);
      for (int y = area.y0; y < area.y1(); ++y) {
        const std::span<double> row = analog.row(y);
        for (std::size_t i = 0; i < row.size(); ++i) row[i] += columns * static_cast<double>(normals[i]);
      }
    }
    if (rows > 0.0) {
      const auto normals = shared_normals(context, state, {0, area.y0, 1, area.ny}, kRowDraw);
      for (int y = area.y0; y < area.y1(); ++y) {
        const double shift = rows * static_cast<double>(normals[static_cast<std::size_t>(y - area.y0)]);
        for (double& value : analog.row(y)) value += shift;
      }
    }
  }
}

}  // namespace astroid
