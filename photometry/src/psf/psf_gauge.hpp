// Which of the PSFs that describe the same stars is meant: flux and position of a star are free to be defined.
#pragma once

#include "astroid/core/effective_psf.hpp"

namespace astroid::detail {

/// Scales to unit flux and shifts to zero centroid everywhere in the field. The centroid is that under a Gaussian
/// window of `sigma` px. @source F143
void fix_gauge(EffectivePsf& psf, double sigma);

}  // namespace astroid::detail
