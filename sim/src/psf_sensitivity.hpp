// How a PSF reacts to motion, measured on the PSF itself.
#pragma once

#include "astroid/core/psf.hpp"
#include "astroid/sim/scene_summary.hpp"

namespace astroid {

/// Largest gradient and curvature of ln F over square masks of 2 to 5 pixels that hold at least 30 % of the flux, and
/// over sub-pixel phases; largest share of the flux in one pixel.
PsfSensitivity measure_sensitivity(const PixelPsf& psf);

}  // namespace astroid
