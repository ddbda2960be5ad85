#include "astroid/analysis/target_metrics.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/jitter_noise.hpp"
#include "astroid/core/photometric.hpp"

namespace astroid {

namespace {

constexpr double kPpm = 1e6;
constexpr double kMagnitudeFactor = 2.5;
// With so many bins their means tell the error of the mean flux, slow noise included; with fewer they scatter too much.
constexpr std::int64_t kBinsForError = 10;
constexpr std::uint32_t kUnclean = measurement_flag::kEdge | measurement_flag::kSaturated |
                                   measurement_flag::kBadPixel | measurement_flag::kOutside |
                                   measurement_flag::kNoFlux | measurement_flag::kSpoiltBackground;

double square(double v) {
  return v * v;
}

/// From noise relative to all light in the aperture to noise relative to the target's.
double all_light_per_target(const TargetMetrics& target) {
  const double stars = target.flux_expected - target.flux_smeared;
  return (target.flux_smeared != 0.0 ? target.flux_expected / stars : 1.0) / target.crowdsap;
}

}  // namespace

RunSetup run_setup(const Mission& mission) {
  RunSetup setup;
  setup.exposures_per_bin = mission.analysis.bin / mission.simulation.cycle;
  setup.cameras = mission.telescope.cameras;
  setup.simulated_cameras = mission.telescope.simulated_cameras;
  setup.prnu = pixel_response_rms(mission);
  setup.flat_field = mission.ccd.flat_field.rms;
  setup.flat_field_exponent = mission.ccd.flat_field.exponent;
  setup.gain_drift = mission.ccd.electronics.gain_drift;
  setup.bias_drift = mission.ccd.electronics.bias_drift * mission.ccd.gain.value();
  setup.uncontaminated_spr = mission.analysis.uncontaminated_spr;
  return setup;
}

double NoiseByCause::total() const {
  return std::sqrt(square(photon) + square(contaminants) + square(background) + square(readout) + square(quantisation) +
                   square(background_estimate) + square(jitter) + square(prnu_jitter) + square(smearing) +
                   square(bias) + square(drift));
}

double NoiseByCause::of_levels() const {
  return std::hypot(std::hypot(background, background_estimate), std::hypot(smearing, bias));
}

MotionNoise after_correction(const MotionNoise& moving, const MotionNoise& error, bool own, double exposures_per_bin) {
  MotionNoise left;
  left.prnu_exposure = moving.prnu_exposure;
  left.prnu_bin = moving.prnu_bin;
  if (own) {
    left.attitude_error = error.jitter_camera;
    return left;
  }
  left.jitter_camera = error.jitter_camera;
  left.jitter_exposure = error.jitter_exposure;
  left.jitter_bin = error.jitter_exposure / exposures_per_bin;
  return left;
}

MotionNoise motion_noise(const StarEstimator& estimator, const StarMotion& motion, const RunSetup& setup) {
  // The estimator's gradient is that of the whole flux in the aperture; the noise is relative to the target's part.
  const double whole = 1.0 / (1.0 - estimator.spr_total);
  const double gx = estimator.gradient_x * whole;
  const double gy = estimator.gradient_y * whole;
  MotionNoise out;
  out.jitter_camera = out.jitter_exposure = motion.exposure.along(gx, gy);
  out.jitter_bin = motion.bin.along(gx, gy);
  // Pixel gains are independent, so the two directions add in quadrature; their correlation through the covariance of
  // the motion is small for any compact PSF and left out.
  const double px = square(setup.prnu * estimator.prnu_gradient_x);
  const double py = square(setup.prnu * estimator.prnu_gradient_y);
  out.prnu_exposure = px * motion.exposure.sxx + py * motion.exposure.syy;
  out.prnu_bin = px * motion.bin.sxx + py * motion.bin.syy;
  return out;
}

PredictedNoise predict_noise(const StarEstimator& estimator, const StarMotion& motion, const RunSetup& setup) {
  return predict_mean_noise(estimator, motion_noise(estimator, motion, setup), setup);
}

PredictedNoise predict_mean_noise(const StarEstimator& estimator, const MotionNoise& motion, const RunSetup& setup) {
  const EstimatorBudget& budget = estimator.budget;
  const double n = setup.exposures_per_bin;
  const double cameras = setup.cameras;
  const double simulated = setup.simulated_cameras;
  const double ppm = kPpm / std::sqrt(cameras * n) / budget.target;
  PredictedNoise out;
  if (!(budget.target > 0.0)) {  // noise without signal; flagged kNoFlux
    out.exposure = out.bin_simulated = out.bin_within = HUGE_VAL;
    out.bin.photon = HUGE_VAL;
    return out;
  }
  out.bin.photon = std::sqrt(budget.var_target) * ppm;
  out.bin.contaminants = std::sqrt(budget.var_contaminants) * ppm;
  out.bin.background = std::sqrt(budget.var_background) * ppm;
  out.bin.readout = std::sqrt(budget.var_readout) * ppm;
  out.bin.quantisation = std::sqrt(budget.var_quantisation) * ppm;
  out.bin.background_estimate = std::sqrt(budget.var_background_estimate) * ppm;
  out.bin.smearing = std::sqrt(budget.var_smearing + budget.var_smearing_correction) * ppm;
  out.bin.bias = std::sqrt(budget.var_bias) * ppm;

  out.bin.jitter = kPpm * std::sqrt(motion.jitter_bin + motion.attitude_error / (n * cameras));
  out.bin.prnu_jitter = kPpm * std::sqrt(motion.prnu_bin / cameras);

  // A sinusoid of amplitude a has the variance a²/2. It is the same in all cameras and, slower than a bin, does not
  // average out.
  const double whole = 1.0 / (1.0 - estimator.spr_total);
  const double drift =
      0.5 * (square(setup.gain_drift * whole) + square(setup.bias_drift * budget.bias_weight / budget.target));
  out.bin.drift = kPpm * std::sqrt(drift);
  const double independent = budget.variance() / square(budget.target) + motion.attitude_error;
  out.exposure = std::sqrt(independent + motion.jitter_camera + motion.prnu_exposure + drift);
  out.bin_common = std::hypot(kPpm * std::sqrt(motion.jitter_bin), out.bin.drift);
  out.bin_simulated = kPpm * std::sqrt((independent / n + motion.prnu_bin) / simulated + motion.jitter_bin + drift);
  // Within a bin the variance is what the mean of the bin has not taken; n / (n - 1) as the estimator divides by n - 1.
  const double bessel = n > 1.0 ? n / (n - 1.0) : 1.0;
  const double shared = bessel * std::max(0.0, motion.jitter_exposure - motion.jitter_bin);
  const double own = independent + bessel * std::max(0.0, motion.prnu_exposure - motion.prnu_bin);
  out.bin_within = kPpm * std::sqrt((own / simulated + shared) / n);
  out.bin_within_common = kPpm * std::sqrt(shared / n);
  return out;
}

TargetMetrics predict_target(const TruthStar& truth, const StarEstimator& estimator, const StarMotion& motion,
                             const RunSetup& setup) {
  return predict_mean_target(truth, estimator, predict_noise(estimator, motion, setup), setup);
}

TargetMetrics predict_mean_target(const TruthStar& truth, const StarEstimator& estimator, const PredictedNoise& noise,
                                  const RunSetup& setup) {
  TargetMetrics target;
  target.id = truth.id;
  target.mag = truth.magnitude;
  target.x = truth.x;
  target.y = truth.y;
  target.flux_in = truth.electrons;
  target.mask_pixels = estimator.mask_pixels;
  target.enclosed_fraction = estimator.enclosed_fraction;
  target.flags = estimator.flags;
  target.predicted = noise;
  target.nsr_exposure = target.predicted.exposure;
  target.nsr_1h_ppm = target.predicted.bin.total();
  target.spr_tot = estimator.spr_total;
  target.crowdsap = 1.0 - estimator.spr_total;
  target.flfrcsap = estimator.enclosed_fraction;
  const double stars = estimator.budget.target + estimator.budget.contaminants;
  target.flux_smeared = estimator.budget.smearing;
  target.flux_expected = stars + target.flux_smeared;
  const double fixed =
      std::sqrt(square(setup.prnu * estimator.prnu_static) +
                square(flat_field_static_noise(setup.flat_field, setup.flat_field_exponent, estimator.prnu_static)));
  target.prnu_magnitude =
      kPogson * fixed * (1.0 - estimator.spr_total) / std::sqrt(static_cast<double>(setup.simulated_cameras));
  target.neighbour_magnitude = kPogson * std::sqrt(estimator.budget.var_neighbour_doubt) / estimator.budget.target;
  target.causes.contamination = kMagnitudeFactor * std::log10(1.0 - estimator.spr_total);
  target.causes.aperture_loss = -kMagnitudeFactor * std::log10(estimator.enclosed_fraction);
  if (target.flux_smeared != 0.0) target.causes.smearing = -kMagnitudeFactor * std::log10(target.flux_expected / stars);
  return target;
}

NoiseEstimate scale_to_cameras(const NoiseEstimate& simulated, double common, const RunSetup& setup) {
  const double fall = static_cast<double>(setup.simulated_cameras) / setup.cameras;
  const auto scale = [common, fall](double noise) {
    const double independent = std::max(0.0, square(noise) - square(common));
    return std::sqrt(independent * fall + std::min(square(noise), square(common)));
  };
  NoiseEstimate out = simulated;
  out.value = scale(simulated.value);
  out.low = scale(simulated.low);
  out.high = scale(simulated.high);
  // d sqrt(V) = dV / (2 sqrt(V)), and dV scales as the independent part does.
  out.error = out.value > 0.0 ? simulated.error * fall * simulated.value / out.value : simulated.error;
  return out;
}

void add_measurement(TargetMetrics& target, const SeriesSummary& series, double reference, std::uint32_t flags,
                     const RunSetup& setup) {
  target.flags |= flags;
  target.exposures = series.exposures;
  target.missing = series.missing;
  target.bins = series.bins;
  if (series.exposures == 0) return;
  target.flux_measured = reference * (1.0 + series.mean);
  // The error of the mean: from bins when there are enough, so that slow noise counts; a single exposure has no scatter
  // and takes the predicted noise.
  double relative =
      target.predicted.exposure * target.crowdsap / std::sqrt(static_cast<double>(setup.simulated_cameras));
  if (series.bins >= kBinsForError) {
    relative = series.bin_means.value / std::sqrt(static_cast<double>(series.bins));
  } else if (series.exposures >= 2) {
    relative = series.exposure.value / std::sqrt(static_cast<double>(series.exposures));
  }
  target.flux_err = std::abs(target.flux_measured) * relative;
  if (target.flux_measured > 0.0) {
    // A ratio of fluxes, so the zero point does not enter.
    target.delta_mag = -kMagnitudeFactor * std::log10(target.flux_measured / target.flux_in);
    target.mag_measured = target.mag + target.delta_mag;
    target.mag_err = kPogson * relative;
    target.causes.residual = target.delta_mag - target.causes.contamination - target.causes.aperture_loss;
    target.causes.residual -= target.causes.smearing;
  }
  const double whole = all_light_per_target(target);
  target.nsr_exposure_measured = series.exposure.scaled(whole);
  target.nsr_1h_within_measured = series.bin_within.scaled(kPpm * whole);
  target.nsr_1h_measured = series.bin_means.scaled(kPpm * whole);
  target.nsr_1h_within_scaled =
      scale_to_cameras(target.nsr_1h_within_measured, target.predicted.bin_within_common, setup);
  target.nsr_1h_scaled = scale_to_cameras(target.nsr_1h_measured, target.predicted.bin_common, setup);
}

void add_uncorrected(TargetMetrics& target, const SeriesSummary& measured) {
  target.nsr_1h_uncorrected = measured.bin_means.scaled(kPpm * all_light_per_target(target));
}

void add_cotrended(TargetMetrics& target, const NoiseEstimate& bin_means) {
  target.nsr_1h_cotrended = bin_means.scaled(kPpm * all_light_per_target(target));
}

bool is_clean(const TargetMetrics& target) {
  return (target.flags & kUnclean) == 0;
}

bool is_uncontaminated(const TargetMetrics& target, const RunSetup& setup) {
  return is_clean(target) && std::isfinite(target.flux_measured) && target.spr_tot < setup.uncontaminated_spr;
}

}  // namespace astroid
