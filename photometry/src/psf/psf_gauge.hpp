// Which of the PSFs that describe the same stars is meant: flux and position of a star are free to be defined.
#pragma once

#include <array>
#include <vector>

#include "astroid/core/effective_psf.hpp"

namespace astroid::detail {

/// What a plane of coefficients adds to a star's flux (of 1) and to its place along x and y (px): the sums of its
/// coefficients times these. @param psf  whose first term tells how a shift changes the moments  @source F143
std::array<std::vector<double>, 3> gauge_weights(const EffectivePsf& psf, double sigma);

/// Scales to unit flux and shifts to zero centroid everywhere in the field. The centroid is that under a Gaussian
/// window of `sigma` px. @source F143
void fix_gauge(EffectivePsf& psf, double sigma);

}  // namespace astroid::detail
