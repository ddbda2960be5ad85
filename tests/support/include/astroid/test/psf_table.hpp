// PSF tables of which everything is known.
#pragma once

#include "astroid/core/psf.hpp"

namespace astroid::test {

/// A circular Gaussian whose samples hold its exact flux, centred between the middle samples.
/// @param half_width  px, rounded up to whole samples.
PsfTable gaussian_psf_table(double sigma, double samples_per_pixel, double half_width);

/// The same with the surface brightness at the sample's centre instead of the flux in the sample: what a table that was
/// evaluated at points looks like.
PsfTable sampled_gaussian_psf_table(double sigma, double samples_per_pixel, double half_width);

}  // namespace astroid::test
