// The PSF of an image, measured from its stars.
#pragma once

#include <cstddef>

#include "astroid/core/effective_psf.hpp"
#include "astroid/core/frame.hpp"
#include "astroid/photometry/background.hpp"

namespace astroid {

struct PsfMeasurementSettings {
  int rounds = 6;                ///< of fitting the field and improving the PSF, at most
  std::size_t most_stars = 600;  ///< the brightest usable ones
  int most_order = 2;            ///< of the polynomials over the field, 0 … 2
  double snr = 30.0;             ///< least, of a star that counts
  MeshSettings mesh;             ///< of the sky
};

struct MeasuredPsf {
  EffectivePsf psf;
  std::size_t stars = 0;    ///< that it was measured from
  double flux_error = 0.0;  ///< sigma of what the PSF's error does to the flux of a bright star, relative
  double from_prior = 1.0;  ///< how far the PSF was allowed to be from a Gaussian, of 1
  double chi2 = 0.0;        ///< per pixel of these stars and degree of freedom; outliers have little weight in it
};

/// Measures the effective PSF of region 0 of a frame.
///
/// It begins with a Gaussian as wide as the image's stars are. All stars are found and fitted together; from what is
/// left in the pixels of the brightest ones, unsaturated and at most half of whose light is of others, follows a better
/// PSF; and again, as long as that makes it better. How near it keeps to a Gaussian of the same width, and the order of
/// its variation over the field, are those that foretell stars which were left out of the fit best; a higher order must
/// gain more than twice the error of the gain. The flux within the grid is 1 for every star, on the mean over sub-pixel
/// phases; what is farther out than about four FWHM is left out and does not count. The centroid, under a Gaussian
/// window of the PSF's own width, is 0.
/// @throws InputError when fewer than 10 stars can be used, or settings are out of range.
/// @accuracy  test: MeasuredPsf.*   @source F140 … F143; AndersonKing2000
MeasuredPsf measure_psf(const Frame& frame, const PsfMeasurementSettings& settings = {});

}  // namespace astroid
