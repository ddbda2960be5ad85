// Fit of one star, or of a few that share pixels: the slow and careful one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

/// The pixels around a group, in electrons above a believed background. Row by row over the box.
struct GroupPixels {
  Rectangle box;
  std::vector<double> electrons;
  std::vector<double> variance;  ///< e-², of all but the photons of the group's own stars; more than 0
  std::vector<char> usable;      ///< 0: masked (saturated, bad, not a number)
};

/// Where a star is believed to be, and its flux; one that is not positive is found first, with all places held.
struct GroupStar {
  PixelPosition position{0.0, 0.0};
  double flux = 0.0;  ///< e-
};

struct GroupFitSettings {
  bool fit_background = true;   ///< a constant, together with the stars
  bool fit_positions = true;    ///< false: fluxes at the given places
  double outlier = 5.0;         ///< sigma; pixels beyond are a cosmic ray's, and are left out
  double psf_doubt = 0.02;      ///< share of a star's light in a pixel that is no outlier though the PSF says otherwise
  double merge_distance = 0.1;  ///< FWHM; stars nearer than this are reported as one
  int most_iterations = 50;     ///< of Levenberg–Marquardt
};

struct FittedStar {
  PixelPosition position{0.0, 0.0};
  double flux = 0.0;  ///< e-; NaN for one that was merged with a brighter one, or cannot be told
  /// FF, Fx, Fy, xx, xy, yy; all others and the background free. Of a star that was held somewhere only FF.
  std::array<double, 6> covariance{};
  std::uint32_t flags = 0;  ///< kMerged, kUnsettled, kOutlier, kOutside, kBadPixel
};

struct GroupFit {
  std::vector<FittedStar> stars;                                       ///< in the order they were given
  double background = 0.0;                                             ///< e- per pixel above the believed one
  double background_error = std::numeric_limits<double>::quiet_NaN();  ///< NaN where it was not fitted
  double chi2 = std::numeric_limits<double>::quiet_NaN();              ///< per degree of freedom
  std::size_t outliers = 0;                                            ///< pixels
};

/// Fits fluxes, places and background of all stars of a group together.
///
/// Pixels have the variance that the model gives them (as FieldSolver has it), so the fit is that of a
/// quasi-likelihood. Outliers are found with a Cauchy loss and left out of the last fit, whose covariance is then that
/// of least squares. Two stars nearer than `merge_distance`, or which the data cannot tell apart (one's error exceeds
/// its flux, and the other is within a FWHM), are reported as one at their common place, the other as NaN, both with
/// kMerged. A star that runs farther than a FWHM (at least 1 px), or whose fit does not converge, has kUnsettled. Never
/// throws for what the pixels hold: a group without enough pixels is NaN with flags.
/// @accuracy  fluxes, places and covariances of the field's solver (test: GroupFit.IsTheFieldSolversOracle)
/// @complexity O(pixels × stars²) an iteration; a star alone takes about 4 ms   @thread safe
/// @source F147; Ceres Solver's trust region and covariance
[[nodiscard]] GroupFit fit_group(const GroupPixels& pixels, const PixelPsf& psf, std::span<const GroupStar> stars,
                                 const GroupFitSettings& settings = {});

}  // namespace astroid
