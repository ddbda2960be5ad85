#include "effects/breathing.hpp"

#include <fmt/format.h>

#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {
constexpr double kEpochShare = 0.1;  ///< of the tolerance, that the change within an epoch may take
}  // namespace

double breathing_variance(const BreathingSettings& settings, Seconds time) {
  const double turns = time / settings.period + settings.phase;
  const double amplitude = settings.amplitude.value();
  return 0.5 * amplitude * amplitude * (1.0 - det::cos(2.0 * kPi * (turns - std::floor(turns))));
}

EffectNeed Breathing::is_needed(const SceneSummary& scene) const {
  const BreathingSettings& settings = scene.mission->psf.breathing;
  const double largest = settings.amplitude.value() * settings.amplitude.value();
  if (!(largest > 0.0)) return {false, "the PSF keeps its width", 0.0, 0.0};
  const double flux = scene.brightest_target_electrons;
  // Half the curvature along x and along y.
  const double bias = scene.psf.curvature * largest;
  const double rms = bias / (2.0 * det::sqrt(2.0));  // of a sinusoid between 0 and `bias`, in all cameras alike
  const double tolerance = flux > 0.0 ? scene.flux_tolerance(flux) / flux : scene.accuracy;
  EffectNeed need;
  need.variance_bound = flux > 0.0 ? rms * rms / scene.relative_variance_in_bin(flux) : 0.0;
  need.bias_bound = bias * flux;
  need.needed = bias > tolerance || need.variance_bound > kVarianceTolerance;
  need.why = fmt::format("a blur of up to {:.3g} px rms every {:.4g} s changes fluxes by up to {:.3g} ppm",
                         settings.amplitude.value(), settings.period.value(), 1e6 * bias);
  // The variance changes by at most largest * pi / period a second.
  if (bias > 0.0) need.steady = Seconds(2.0 * kEpochShare * tolerance / (bias * kPi) * settings.period.value());
  return need;
}

void Breathing::set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const {
  conditions.psf_variance += breathing_variance(scene.mission().psf.breathing, quarter_start(scene.mission()) + time);
}

void Breathing::apply(ExposureState& /*state*/, const EffectContext& /*context*/, const Strip& /*strip*/) const {}

}  // namespace astroid
