// Everything the analysis says of one target: a row of analysis/targets.csv.
//
// Noise is relative to the flux of the target alone in its aperture, predicted and measured alike. A light curve
// carries contaminants too, so its relative noise is divided by 1 - SPR before it is compared.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/analysis/motion.hpp"
#include "astroid/analysis/nsr_accumulator.hpp"
#include "astroid/analysis/truth.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// What the analysis must know of a run besides its stars.
struct RunSetup {
  double exposures_per_bin = 144.0;  ///< bin / cycle
  int cameras = 1;                   ///< N that observe the field
  int simulated_cameras = 1;         ///< n <= N whose mean the measured series is
  double prnu = 0.0;                 ///< rms of pixel gains that calibration leaves, relative
  double flat_field = 0.0;           ///< rms of a large-scale pattern that calibration leaves, relative
  double flat_field_exponent = 1.0;  ///< of its spectrum
  double gain_drift = 0.0;           ///< amplitude of a slow change of the gain that calibration leaves, relative
  double bias_drift = 0.0;           ///< the same of the bias, e-
  double uncontaminated_spr = 1e-3;  ///< stars with less contamination judge magnitude recovery
};
/// Unequal sensitivity is not corrected, so the whole of CCD/PRNU and CCD/FlatField is left, unless the caller knows
/// better.
RunSetup run_setup(const Mission& mission);

/// Noise of the mean over one bin by its cause, ppm of the target's flux in the aperture.
struct NoiseByCause {
  double photon = 0.0;        ///< of the target
  double contaminants = 0.0;  ///< photon noise of all other stars
  double background = 0.0;    ///< photon noise of sky and dark current under the aperture
  double readout = 0.0;
  double quantisation = 0.0;
  double background_estimate = 0.0;  ///< of the local background
  double jitter = 0.0;               ///< light that crosses the edge of the aperture; common to all cameras
  double prnu_jitter = 0.0;          ///< the star moving over unequal pixels; differs from camera to camera
  double smearing = 0.0;             ///< photon noise of what is smeared into the aperture, and of its correction
  double bias = 0.0;                 ///< of a measured bias, and offsets of rows
  double drift = 0.0;                ///< of gain and bias, slower than a bin; common to all cameras
  [[nodiscard]] double total() const;
  /// What comes with the pixels and not with the stars, readout apart: sky, dark, smearing, and the levels subtracted.
  [[nodiscard]] double of_levels() const;
};

/// Predicted noise of one target.
struct PredictedNoise {
  double exposure = 0.0;           ///< NSR of one exposure of one camera, jitter included; mean where they differ
  NoiseByCause bin;                ///< N cameras, ppm
  double bin_simulated = 0.0;      ///< total with the n simulated cameras, ppm: beside what was measured
  double bin_within = 0.0;         ///< what the scatter within bins should give with the n simulated cameras, ppm
  double bin_common = 0.0;         ///< the part that cameras share (jitter), ppm
  double bin_within_common = 0.0;  ///< the same of bin_within: jitter faster than a bin
};

/// What motion does to a flux: variances relative to that of the target.
struct MotionNoise {
  double jitter_camera = 0.0;    ///< light across the edge of the aperture, in one exposure of one camera
  double jitter_exposure = 0.0;  ///< the same in one exposure of all cameras: it is common to them
  double jitter_bin = 0.0;       ///< and in the mean over a bin
  double prnu_exposure = 0.0;    ///< unequal pixels, in one exposure of one camera
  double prnu_bin = 0.0;         ///< in a bin of one camera
  /// What jitter correction by an attitude that each camera measures for itself puts in, in one exposure of one camera:
  /// independent from exposure to exposure and from camera to camera.
  double attitude_error = 0.0;
};
/// What is left after jitter correction: of the light across the edge of the aperture only what the error of the
/// attitude leaves; unequal pixels are not corrected for.
/// @param moving  before.  @param error  the same of the error of the attitude, as if the camera moved by it.
/// @param own     whether each camera has its own error; else all share it. It is new in every exposure.
MotionNoise after_correction(const MotionNoise& moving, const MotionNoise& error, bool own, double exposures_per_bin);

/// Where all cameras move alike.
MotionNoise motion_noise(const StarEstimator& estimator, const StarMotion& motion, const RunSetup& setup);

/// Predicts the noise of a target: independent terms fall as 1 / sqrt(cameras * exposures), jitter by the motion
/// that is left in the mean and not with cameras, PRNU with jitter by the motion and with cameras.
PredictedNoise predict_noise(const StarEstimator& estimator, const StarMotion& motion, const RunSetup& setup);
/// The same of the mean of groups: of mean_estimator() and mean_motion_noise().
PredictedNoise predict_mean_noise(const StarEstimator& estimator, const MotionNoise& motion, const RunSetup& setup);

/// Differences of magnitude, each a cause: measured - true = contamination + aperture_loss + smearing + residual.
struct MagnitudeCauses {
  double contamination = 0.0;                                  ///< 2.5 log10(1 - SPR_tot), <= 0: neighbours brighten
  double aperture_loss = 0.0;                                  ///< -2.5 log10(enclosed fraction), >= 0
  double smearing = 0.0;                                       ///< <= 0 with a known sky: columns brighten
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< what neither explains: saturation, background, bias
};

struct TargetMetrics {
  std::string id;
  double mag = 0.0;
  double x = 0.0, y = 0.0;
  int mask_pixels = 0;
  double enclosed_fraction = 0.0;
  double nsr_exposure = 0.0;  ///< predicted.exposure
  double nsr_1h_ppm = 0.0;    ///< predicted.bin.total()
  PredictedNoise predicted;
  double spr_tot = 0.0;        ///< stellar pollution ratio, sky excluded
  double crowdsap = 0.0;       ///< 1 - spr_tot
  double flfrcsap = 0.0;       ///< target's flux in the aperture / all flux of the target
  double flux_in = 0.0;        ///< e- per exposure, all of the PSF
  double flux_expected = 0.0;  ///< e- per exposure: target, contaminants and what is smeared into the aperture
  double flux_smeared = 0.0;   ///< the last of these, 0 where it is corrected
  std::uint32_t flags = 0;     ///< measurement_flag bits
  double prnu_magnitude =
      0.0;  ///< expected rms error of the magnitude by fixed unequal pixels and the flat field, n cameras, mag
  double neighbour_magnitude = 0.0;  ///< the same by the doubt of neighbours' light that PSF weights take out, mag

  std::int64_t exposures = 0, missing = 0;
  double flux_measured = std::numeric_limits<double>::quiet_NaN();  ///< mean, e- per exposure, in the aperture
  double flux_err = std::numeric_limits<double>::quiet_NaN();       ///< standard error of that mean
  double mag_measured = std::numeric_limits<double>::quiet_NaN();   ///< of flux_measured; NaN unless it is positive
  double mag_err = std::numeric_limits<double>::quiet_NaN();
  double delta_mag = std::numeric_limits<double>::quiet_NaN();  ///< mag_measured - mag
  MagnitudeCauses causes;
  NoiseEstimate nsr_exposure_measured;   ///< relative, n cameras
  NoiseEstimate nsr_1h_within_measured;  ///< ppm, within bins, n cameras
  NoiseEstimate nsr_1h_measured;         ///< ppm, by bin means, n cameras
  NoiseEstimate nsr_1h_within_scaled;    ///< the same scaled to N cameras
  NoiseEstimate nsr_1h_scaled;
  NoiseEstimate nsr_1h_uncorrected;  ///< as nsr_1h_measured, before jitter correction; nothing without one
  NoiseEstimate
      nsr_1h_cotrended;  ///< as nsr_1h_measured, without what targets have in common; nothing unless asked for
  std::int64_t bins = 0;
};

/// The row of a target as far as it is known beforehand.
TargetMetrics predict_target(const TruthStar& truth, const StarEstimator& estimator, const StarMotion& motion,
                             const RunSetup& setup);
/// The same of the mean of groups: of mean_truth(), mean_estimator() and predict_mean_noise().
TargetMetrics predict_mean_target(const TruthStar& truth, const StarEstimator& estimator, const PredictedNoise& noise,
                                  const RunSetup& setup);

/// Adds what was measured.
/// @param reference  e- per exposure, the flux that the series is relative to.
/// @param flags      measurement_flag bits seen in any exposure, added to those of the estimator.
void add_measurement(TargetMetrics& target, const SeriesSummary& series, double reference, std::uint32_t flags,
                     const RunSetup& setup);

/// Adds the noise that was measured before jitter correction, after add_measurement().
void add_uncorrected(TargetMetrics& target, const SeriesSummary& measured);

/// Adds the noise that cotrending leaves, after add_measurement().  @param bin_means  of deviations, with its freedom.
void add_cotrended(TargetMetrics& target, const NoiseEstimate& bin_means);

/// A noise of n simulated cameras as it would be with N: only what cameras do not share falls.
/// @param common  the shared part, in the unit of `simulated`; a measured noise below it is all taken as shared.
NoiseEstimate scale_to_cameras(const NoiseEstimate& simulated, double common, const RunSetup& setup);

/// True for a star whose flux means what it says: not saturated, cut, defective, outside or without light.
bool is_clean(const TargetMetrics& target);
/// is_clean, measured, and with less contamination than the configured share.
bool is_uncontaminated(const TargetMetrics& target, const RunSetup& setup);

/// A measurement flag and what it means.
struct FlagName {
  std::uint32_t bit;
  std::string_view name;
  std::string_view meaning;
};
const std::vector<FlagName>& flag_names();
/// "edge|saturated", or "" without flags; an unknown bit appears as "bit12".
std::string flag_text(std::uint32_t flags);

}  // namespace astroid
