// Where the stars of an image are: a matched filter, and peaks told apart where their light runs together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/photometry/background.hpp"

namespace astroid {

struct DetectionSettings {
  double threshold = 5.0;  ///< least height of a peak of the filtered image, in units of its noise
  double footprint = 1.5;  ///< height down to which pixels belong to a peak, in the same units
  /// A peak beside a higher one stands above the saddle between them by this many times the noise there …
  double prominence = 2.0;
  double contrast = 0.005;        ///< … and by this part of the higher one
  const PixelPsf* psf = nullptr;  ///< that says how wide stars are; nullptr: measured in the image
};

struct DetectedStar {
  double x = 0.0;  ///< px, 0-based
  double y = 0.0;
  double position_error = 0.0;  ///< px, along each axis; of photon noise and the noise of the sky
  double significance = 0.0;    ///< height of its peak in units of the noise of the sky
  double light = 0.0;           ///< e-, of a Gaussian star with that peak at the centre of a pixel
  int area = 0;                 ///< px, of its footprint
};

struct Detection {
  std::vector<DetectedStar> stars;  ///< in the order of rows of their peaks
  double fwhm = 0.0;                ///< px, of stars; the filter is a Gaussian of 0.7 times that
  bool fwhm_measured = false;       ///< else the PSF was given, or no star was bright enough and a default was taken
};

/// FWHM of stars in region 0 of a frame: the median, over bright peaks, of that of a Gaussian through three pixels in a
/// row or column. It does not depend on where in its pixel a Gaussian star lies; the pixel itself widens it.
/// @returns NaN with fewer than five peaks of 20 times the noise that are not saturated, flagged, or at the edge.
/// @accuracy 5 % for FWHM of 1.3 to 6 px; stars much wider look narrower, by the noise on their tops (test:
/// MeasureFwhm.IsThatOfTheStars)
[[nodiscard]] double measure_fwhm(const Frame& frame, const BackgroundMap& background);

/// Finds stars in region 0 of a frame. Pixels that are flagged or not finite count as sky, saturated ones as they are.
///
/// Every pixel of the filtered image above `footprint` belongs to the peak that a path uphill leads to; peaks are
/// joined over their saddles, the highest first, unless the lower one is prominent. That is deblending by infinitely
/// many thresholds.
/// @throws InputError unless the thresholds are positive and finite
/// @complexity O(pixels + peaks log peaks)
/// @source F152; BertinArnouts1996 §6; differs: thresholds are not steps, and prominence is in units of the noise.
[[nodiscard]] Detection detect_stars(const Frame& frame, const BackgroundMap& background,
                                     const DetectionSettings& settings);

}  // namespace astroid
