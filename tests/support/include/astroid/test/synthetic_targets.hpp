// A field of targets as an assessment would leave it, made from closed forms: for tests of what judges and draws them.
// The link needs astroid::analysis.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/test/gaussian_series.hpp"

namespace astroid::test {

/// What the field is made of: a PLATO camera (zero point 20.62, 21 s, sky 945 e-/px, readout 50.2 e-, 25 e-/ADU).
struct SyntheticField {
  std::size_t stars = 400;
  double faintest = 14.0, brightest = 6.0;  // mag
  std::int64_t bins = 24;                   // hours observed
  double noise_factor = 1.0;                // measured / predicted noise
  double flux_factor = 1.0;                 // measured / expected flux
  std::uint64_t seed = 1;
};

inline RunSetup plato_setup() {
  RunSetup setup;
  setup.exposures_per_bin = 144.0;
  setup.cameras = 24;
  setup.simulated_cameras = 1;
  setup.prnu = 0.01;
  return setup;
}

/// A star's estimator from what a mask of `pixels` pixels collects.
inline StarEstimator synthetic_estimator(double electrons, double contaminant_electrons, int pixels, double enclosed) {
  constexpr double kSky = 945.0;
  constexpr double kReadout = 50.2;
  constexpr double kQuantisation = 7.2;
  StarEstimator e;
  e.mask_pixels = pixels;
  e.enclosed_fraction = enclosed;
  e.budget.target = electrons * enclosed;
  e.budget.contaminants = contaminant_electrons;
  e.budget.var_target = e.budget.target;
  e.budget.var_contaminants = contaminant_electrons;
  e.budget.var_background = pixels * kSky;
  e.budget.var_readout = pixels * kReadout * kReadout;
  e.budget.var_quantisation = pixels * kQuantisation * kQuantisation;
  e.budget.var_background_estimate = 0.1 * pixels * kSky;
  e.spr_total = contaminant_electrons / (e.budget.target + contaminant_electrons);
  e.nsr_exposure = std::sqrt(e.budget.variance()) / e.budget.target;
  e.gradient_x = 0.06;
  e.gradient_y = -0.05;
  e.prnu_gradient_x = 0.45;
  e.prnu_gradient_y = 0.45;
  e.prnu_static = 0.43;
  return e;
}

inline StarMotion plato_motion() {
  constexpr double kDisplacement = 0.038 / 15.0;          // px rms
  constexpr double kInExposure = 0.986, kInHour = 0.360;  // of the rms that is left in the means
  const double exposure = kDisplacement * kDisplacement * kInExposure * kInExposure;
  const double hour = kDisplacement * kDisplacement * kInHour * kInHour;
  return {{exposure, 0.0, exposure}, {hour, 0.0, hour}};
}

/// A sample standard deviation (n - 1) of unit noise with `dof` degrees of freedom, by its normal approximation of the
/// cube root of chi-squared.
inline double drawn_deviation(GaussianSeries& gauss, std::int64_t dof) {
  const double a = 2.0 / (9.0 * static_cast<double>(dof));
  const double root = 1.0 - a + gauss.next() * std::sqrt(a);
  return std::sqrt(root * root * root);
}

inline std::vector<TargetMetrics> synthetic_targets(const SyntheticField& field) {
  constexpr double kZeroPoint = 20.62;
  constexpr double kExposure = 21.0;   // s
  constexpr double kSaturation = 7.8;  // mag
  const RunSetup setup = plato_setup();
  const StarMotion motion = plato_motion();
  GaussianSeries gauss(field.seed);
  std::vector<TargetMetrics> targets;
  for (std::size_t i = 0; i < field.stars; ++i) {
    TruthStar truth;
    truth.id = fmt::format("S{:05d}", i);
    // Numbers rise with magnitude as in the sky: uniform in the cube root of the count.
    truth.magnitude = field.brightest + (field.faintest - field.brightest) * std::cbrt(gauss.uniform());
    truth.x = 4000.0 * gauss.uniform();
    truth.y = 4000.0 * gauss.uniform();
    truth.electrons = std::pow(10.0, -0.4 * (truth.magnitude - kZeroPoint)) * kExposure;
    const int pixels =
        std::clamp(static_cast<int>(std::lround(13.0 - 0.6 * (truth.magnitude - 8.0) + gauss.next())), 4, 16);
    const double enclosed = 1.0 - 0.45 * std::exp(-0.32 * pixels);
    const double share = std::min(0.4, std::pow(10.0, -3.6 + 0.28 * (truth.magnitude - 10.0) + 0.8 * gauss.next()));
    StarEstimator estimator =
        synthetic_estimator(truth.electrons, truth.electrons * enclosed * share / (1.0 - share), pixels, enclosed);
    TargetMetrics target = predict_target(truth, estimator, motion, setup);

    const std::int64_t bins = field.bins;
    const std::int64_t exposures = bins * 144;
    const double whole = target.crowdsap;
    SeriesSummary series;
    series.exposures = exposures;
    series.bins = bins;
    series.exposure = noise_estimate(
        target.predicted.exposure * whole * field.noise_factor * drawn_deviation(gauss, exposures - 1), exposures - 1);
    const double within = target.predicted.bin_within * 1e-6 * whole * field.noise_factor;
    series.bin_within = noise_estimate(within * drawn_deviation(gauss, exposures - bins), exposures - bins);
    const double means = target.predicted.bin_simulated * 1e-6 * whole * field.noise_factor;
    if (bins >= 2) series.bin_means = noise_estimate(means * drawn_deviation(gauss, bins - 1), bins - 1);
    const double mean_error = means / std::sqrt(static_cast<double>(bins));
    const double fixed = target.prnu_magnitude / 1.0857362047581294;
    series.mean = field.flux_factor * (1.0 + mean_error * gauss.next() + fixed * gauss.next()) - 1.0;
    std::uint32_t flags = 0;
    if (truth.magnitude < kSaturation + 0.1 * gauss.next()) {
      flags = measurement_flag::kSaturated;
      series.mean = (1.0 + series.mean) * std::pow(10.0, -0.25 * std::max(0.0, kSaturation - truth.magnitude)) - 1.0;
    }
    add_measurement(target, series, target.flux_expected, flags, setup);
    targets.push_back(target);
  }
  return targets;
}

}  // namespace astroid::test
