// The numbers of a scene on which the plan decides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "astroid/core/mission.hpp"

namespace astroid {

/// How strongly the flux in a mask reacts to a displacement of the star; maxima over sub-pixel phases and masks.
struct PsfSensitivity {
  double gradient = 0.0;                   ///< |d ln F / dx|, 1/px
  double curvature = 0.0;                  ///< |d² ln F / dx²|, 1/px²
  double peak_fraction = 0.0;              ///< largest share of the flux in one pixel
  std::array<double, 7> derivatives{1.0};  ///< |d^n F / dx^n| / F, px^-n, index n
};

/// Full-frame numbers of a scene: of the whole catalogue, never of the windows that happen to be computed.
struct SceneSummary {
  const Mission* mission = nullptr;
  std::size_t stars = 0;
  std::size_t targets = 0;
  std::string brightest_id;
  double brightest_electrons = 0.0;  ///< per exposure
  double brightest_magnitude = 0.0;
  double peak_pixel_bound = 0.0;  ///< e-, upper bound of any pixel's expectation
  double brightest_column = 0.0;  ///< e-, upper bound of the light of any column
  double faintest_target_electrons = 0.0;
  double brightest_target_electrons = 0.0;  ///< of those that do not saturate
  double sky = 0.0;                         ///< on the axis in the middle of the run, e- per pixel and exposure
  double background = 0.0;                  ///< expected sky + stray light + dark, e- per pixel and exposure
  double pixel_noise_variance = 0.0;        ///< background + readout² + quantisation², e-²
  double least_vignetting = 1.0;            ///< at the corners of the detector, relative to the axis
  std::size_t ghosts = 0;                   ///< that may touch the detector
  double ghost_light = 0.0;                 ///< e- per pixel and exposure, were all of them in one place
  double aperture_pixels = 0.0;             ///< area that bounds any target's aperture
  double exposures_per_bin = 1.0;           ///< in the longest time bin reported
  int cameras = 1;
  double attitude_rms_px = 0.0;              ///< largest displacement rms of one axis anywhere on the frame
  double attitude_rms_in_exposure_px = 0.0;  ///< rms of the motion about its mean within one exposure
  std::size_t variable_stars = 0;            ///< on the detector
  double largest_variation = 0.0;            ///< e- per exposure, of any of them
  std::size_t moved_stars = 0;               ///< that have a proper motion
  double proper_motion_px = 0.0;             ///< the farthest that one was moved to the epoch of the run
  double epoch = 2000.0;                     ///< of the middle of the run, Julian year
  double drift_px = 0.0;                     ///< largest displacement of any star by drift over the run
  double drift_px_per_second = 0.0;          ///< the fastest that drift moves any star
  double repointing_px = 0.0;                ///< and by the errors of re-pointing
  double aberration_px = 0.0;                ///< and by aberration
  double aberration_px_per_second = 0.0;     ///< the fastest that aberration moves any star
  std::size_t listed_dead = 0;               ///< pixels, by a file
  std::size_t listed_hot = 0;
  double hottest = 0.0;  ///< e- per exposure, of the listed hot pixels
  PsfSensitivity psf;
  double accuracy = 1e-6;  ///< the accuracy asked for, relative

  /// What all approximations together may add to a target's flux, e- per exposure:
  /// max(accuracy F, 0.01 sigma_F over the reported duration with all cameras) (docs/accuracy.md).
  [[nodiscard]] double flux_tolerance(double target_electrons) const;
  /// How much a displacement of so many pixels may change a flux, relative; at most 1.
  [[nodiscard]] double flux_change(double displacement) const;
  /// The smallest flux tolerance of any target.
  [[nodiscard]] double tightest_tolerance() const;
  /// Variance of a target's flux averaged over the reported duration and all cameras, relative to its flux squared,
  /// by photon, background and readout noise only: what skipped variance is measured against.
  [[nodiscard]] double relative_variance_in_bin(double target_electrons) const;
};

/// Variance that may be left out of a flux, relative to its variance: 0.1 % of variance is 0.05 % of noise.
inline constexpr double kVarianceTolerance = 1e-3;

}  // namespace astroid
