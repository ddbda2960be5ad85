#include "effects/nonlinearity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/response.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed NonLinearity::is_needed(const SceneSummary& scene) const {
  const CcdSettings& ccd = scene.mission->ccd;
  const ElectronicResponse response = make_response(ccd.electronics.nonlinearity);
  if (response.is_linear()) return {false, "the electronics are linear", 0.0, 0.0};
  // Of a flux F whose pixels lie between 0 and the brightest: a0 in every pixel, and at most |a1| + |a2| I of the rest.
  const double gain = ccd.gain.value();
  const double highest = std::min(scene.peak_pixel_bound, ccd.full_well.value()) / gain;
  const double relative = std::fabs(response.a1) + std::fabs(response.a2) * highest;
  const double flux = scene.brightest_target_electrons;
  const double constant = std::fabs(response.a0) * gain * scene.aperture_pixels;
  const double bias = constant + relative * (flux + scene.background * scene.aperture_pixels);
  const double tolerance = scene.tightest_tolerance();
  // What is bent is the signal of an exposure, noise included.
  constexpr double kSigmas = 5.0;
  const double faintest = scene.faintest_target_electrons;
  const double noise = det::sqrt(faintest + scene.aperture_pixels * scene.pixel_noise_variance);
  const double allowed = faintest > 0.0 ? scene.accuracy / (1.0 + kSigmas * noise / faintest) : 0.0;
  return {constant > tolerance || relative > allowed,
          fmt::format(
              "bends a signal of {:.4g} ADU, the brightest pixel, by at most {:.3g} ppm, every pixel by {:.3g} ADU; "
              "the accuracy asked for is {:.3g} ppm",
              highest, 1e6 * relative, std::fabs(response.a0), 1e6 * scene.accuracy),
          bias, 2.0 * relative};
}

void NonLinearity::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  // The bias is added later, so what is here is the signal above it.
  bend(make_response(context.scene.mission().ccd.electronics.nonlinearity), 0.0, state.analog.pixels(strip));
}

}  // namespace astroid
