#include "effects/rolling_shutter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "astroid/core/math.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/rolling_shutter.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed RollingShutter::is_needed(const SceneSummary& scene) const {
  const Mission& mission = *scene.mission;
  const double readout = mission.cmos.line_time.value() * mission.ccd.rows;
  if (!(readout > 0.0)) return {false, "all rows are exposed at once (LineTime 0)", 0.0, 0.0};
  const RowTiming timing(scene, Seconds(readout));
  const bool varies = scene.variable_stars > 0 && scene.largest_variation > scene.tightest_tolerance();
  const double bias = timing.bias + (scene.variable_stars > 0 ? scene.largest_variation : 0.0);
  return {varies || timing.variance_ratio > kVarianceTolerance || timing.bias > scene.tightest_tolerance(),
          fmt::format("the last row is exposed {:.4g} s after the first; meanwhile motion changes fluxes by {:.3g} ppm "
                      "rms and up to {:.3g} e-, and variable stars by up to {:.3g} e-; the tightest flux tolerance is "
                      "{:.3g} e-",
                      readout, 1e6 * timing.rms, timing.bias, scene.variable_stars > 0 ? scene.largest_variation : 0.0,
                      scene.tightest_tolerance()),
          bias, timing.variance_ratio};
}

void RollingShutter::apply(ExposureState& state, const EffectContext& context, const Strip& /*strip*/) const {
  state.line_time = context.scene.mission().cmos.line_time;
  const AttitudeSeries& series = context.attitude;
  if (series.moments.empty() || series.bands == 1) return;
  const auto bands = static_cast<std::size_t>(series.bands);
  const auto steps = static_cast<std::size_t>(series.steps);
  const std::size_t first = static_cast<std::size_t>(state.exposure) * bands;
  state.bands.rows = context.knobs.band_rows;
  state.bands.attitude = std::span(series.moments).subspan(first, bands);
  if (!series.samples.empty()) state.bands.steps = std::span(series.samples).subspan(first * steps, bands * steps);
}

void look_at_row(ExposureState& state, int y) {
  const RowBands& bands = state.bands;
  if (bands.attitude.empty()) return;
  const auto last = static_cast<int>(bands.attitude.size()) - 1;
  const auto band = static_cast<std::size_t>(std::clamp(y / bands.rows, 0, last));
  state.attitude = bands.attitude[band];
  if (bands.steps.empty()) return;
  const std::size_t steps = bands.steps.size() / bands.attitude.size();
  state.attitude_steps = bands.steps.subspan(band * steps, steps);
}

}  // namespace astroid
