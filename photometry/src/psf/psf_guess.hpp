// A first guess of the PSF of an image: a circular Gaussian as wide as its stars.
#pragma once

#include "astroid/core/effective_psf.hpp"
#include "field/field_solver.hpp"

namespace astroid::detail {

/// Sigma of the stars, px, before integration over the pixel; 0 without a bright star.
///
/// Of the values a, b, c of a Gaussian in three pixels in a row, ln(b² / (a c)) is 1 / sigma² wherever between them the
/// star is. The median over the brightest local maxima, along x and y, is taken. @source F140
double guess_sigma(const FieldPixels& pixels);

/// The same PSF as an effective one of `samples_per_pixel`, within `half` samples.
EffectivePsf effective_gaussian(double sigma, int samples_per_pixel, int half);

/// Sigma of the Gaussian that is nearest to the first term of an effective PSF, least squares.
double nearest_sigma(const EffectivePsf& psf);

}  // namespace astroid::detail
