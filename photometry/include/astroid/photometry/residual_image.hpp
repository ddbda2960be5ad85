// What is left of an image when its background and its measured stars are taken out.
#pragma once

#include <span>

#include "astroid/core/frame.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/photometry/background.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

/// Image less background less flux times PSF of every source whose flux is a number, in ADU; NaN where a pixel is not
/// finite.
///
/// @param psf     fluxes must be those of whole stars.
/// @returns       over the area of region 0.
[[nodiscard]] Image<float, unit::Adu> residual_image(const Frame& frame, const BackgroundMap& background,
                                                     std::span<const SourceMeasurement> sources, const PixelPsf& psf);

}  // namespace astroid
