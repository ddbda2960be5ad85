#include "effects/need.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {
/// A pixel of the noisiest exposure of a run stays below its expectation plus this many standard deviations.
constexpr double kSigmas = 10.0;
}  // namespace

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

EffectNeed full_well_need(const SceneSummary& scene) {
  const double highest = scene.peak_pixel_bound + kSigmas * det::sqrt(scene.peak_pixel_bound);
  const double full_well = scene.mission->ccd.full_well.value();
  const bool needed = highest > full_well;
  return {needed,
          fmt::format(
              "the brightest pixel holds at most {:.4g} e- ({} sigma above its expectation), the full well {:.4g} e-",
              highest, kSigmas, full_well),
          std::max(0.0, highest - full_well), needed ? 1.0 : 0.0};
}

EffectNeed noise_need(const SceneSummary& scene, double rms, std::string_view what) {
  const double variance = rms * rms;
  const double rest = scene.faintest_target_electrons + scene.background;
  const double ratio = rest > 0.0 ? variance * scene.aperture_pixels / rest : 1.0;
  return {ratio > kVarianceTolerance,
          fmt::format("{:.4g} {}; photon noise of the faintest target is at least {:.4g} e-²", rms, what, rest), 0.0,
          ratio};
}

std::optional<EffectNeed> common_to_reads(const SceneSummary& scene, double rms, const std::string& what) {
  const Mission& mission = *scene.mission;
  if (mission.cmos.reads <= 1) return std::nullopt;
  const double reach = kSigmas * (rms + mission.ccd.readout_noise.value()) / mission.ccd.gain.value();
  const double bias = mission.ccd.bias.value();
  const double top = bias + (mission.ccd.full_well / mission.ccd.gain).value();
  if (bias > reach && top + reach < adc_top(mission.ccd.adc_bits))
    return EffectNeed{false,
                      fmt::format("{} are the same in all reads of an exposure, so the fit of the ramp does not have "
                                  "them",
                                  what),
                      0.0, 0.0};
  return EffectNeed{true, fmt::format("{} may push reads beyond the range of the ADC", what), 0.0, 0.0};
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
