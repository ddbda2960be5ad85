#include "effects/need.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace astroid {

EffectNeed background_need(const SceneSummary& scene, double level, std::string_view what) {
  const double in_aperture = level * scene.aperture_pixels;
  const double faintest = scene.faintest_target_electrons;
  const double least_variance = faintest + scene.pixel_noise_variance - scene.background;
  const double variance_ratio = least_variance > 0.0 ? in_aperture / least_variance : (in_aperture > 0.0 ? 1.0 : 0.0);
  const bool needed = in_aperture > scene.tightest_tolerance() || variance_ratio > kVarianceTolerance;
  return {
      needed && level > 0.0,
      fmt::format(
          "{} gives {:.4g} e- per pixel and exposure, {:.4g} e- in {:.3g} px; the tightest flux tolerance is {:.3g} e-",
          what, level, in_aperture, scene.aperture_pixels, scene.tightest_tolerance()),
      in_aperture, variance_ratio};
}

EffectNeed response_need(const SceneSummary& scene, double rms, std::string_view what) {
  // The largest error of a flux is that of a star whose light is all in one pixel.
  const double flux = scene.brightest_target_electrons;
  const double gradient = rms * scene.psf.gradient * scene.attitude_rms_px;
  const double variance_ratio = flux > 0.0 ? gradient * gradient / scene.relative_variance_in_bin(flux) : 0.0;
  return {rms > scene.accuracy || variance_ratio > kVarianceTolerance,
          fmt::format("{} changes each flux by up to {:.3g} ppm, the accuracy asked for is {:.3g} ppm", what, 1e6 * rms,
                      1e6 * scene.accuracy),
          rms * flux, variance_ratio};
}

EffectNeed moved_charge_need(const SceneSummary& scene, double share, std::string_view what) {
  const double full_well = scene.mission->ccd.full_well.value();
  const double fullest = std::min(scene.peak_pixel_bound, full_well);
  const double bias = share * fullest * scene.aperture_pixels;
  const double variance_ratio = 2.0 * share;
  return {bias > scene.tightest_tolerance() || variance_ratio > kVarianceTolerance,
          fmt::format("{} moves up to {:.3g} of the charge of a pixel, {:.4g} e- in {:.3g} px; the tightest flux "
                      "tolerance is {:.3g} e-",
                      what, share, bias, scene.aperture_pixels, scene.tightest_tolerance()),
          bias, variance_ratio};
}

}  // namespace astroid
