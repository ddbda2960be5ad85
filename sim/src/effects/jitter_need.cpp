#include "effects/jitter_need.hpp"

#include <fmt/format.h>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

EffectNeed jitter_need(const SceneSummary& scene) {
  const double rms = scene.attitude_rms_px;
  const double flux = scene.brightest_target_electrons;
  // Two axes move independently. Jitter is common to all cameras and is red, so it may not average down at all in the
  // longest bin: its variance is compared with what is left of the other noise there.
  const double relative_variance = 2.0 * scene.psf.gradient * scene.psf.gradient * rms * rms;
  const double relative_bias = scene.psf.curvature * rms * rms;
  const double variance_ratio = flux > 0.0 ? relative_variance / scene.relative_variance_in_bin(flux) : 0.0;
  const bool needed =
      rms > 0.0 && (variance_ratio > kVarianceTolerance || relative_bias * flux > scene.flux_tolerance(flux));
  return {needed,
          fmt::format("up to {:.3g} px rms moves the flux of the brightest unsaturated target by at most {:.3g} ppm "
                      "rms in an exposure; "
                      "its other noise in {:.3g} exposures of {} camera(s) is {:.3g} ppm",
                      rms, 1e6 * det::sqrt(relative_variance), scene.exposures_per_bin, scene.cameras,
                      flux > 0.0 ? 1e6 * det::sqrt(scene.relative_variance_in_bin(flux)) : 0.0),
          relative_bias * flux, variance_ratio};
}

void take_attitude(ExposureState& state, const AttitudeSeries& series) {
  // With a rolling shutter that of the middle band, until rows are looked at.
  const auto bands = static_cast<std::size_t>(series.bands);
  const std::size_t exposure = static_cast<std::size_t>(state.exposure) * bands + bands / 2;
  ASTROID_CHECK_LT(exposure, series.moments.size());
  state.attitude = series.moments[exposure];
  if (series.samples.empty()) return;
  const auto steps = static_cast<std::size_t>(series.steps);
  state.attitude_steps = std::span(series.samples).subspan(exposure * steps, steps);
}

}  // namespace astroid
