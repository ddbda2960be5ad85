#include "effects/need.hpp"

#include <fmt/format.h>

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

}  // namespace astroid
