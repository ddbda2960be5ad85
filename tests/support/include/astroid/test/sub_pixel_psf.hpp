// The sub-pixel renderer in the clothes of a pixel-integrated PSF, so that one test body fits every renderer.
#pragma once

#include <memory>
#include <vector>

#include "astroid/core/pixel_response.hpp"
#include "astroid/core/psf_spectrum.hpp"
#include "astroid/core/sub_pixel.hpp"

namespace astroid::test {

/// Renders every star alone on a detector of 2 reach + 1 pixels around it; pixels beyond get nothing.
/// It has no gradients. @param settings  as for the renderer
std::shared_ptr<const PixelPsf> make_sub_pixel_psf(std::shared_ptr<const PsfSpectrum> spectrum, int reach,
                                                   const SubPixelSettings& settings);

/// Light of a star in pixels, from the cells of the map times their sensitivity.
/// @param response  of as many cells a pixel as the renderer makes
std::vector<double> light_by_cells(const SubPixelRenderer& renderer, const PixelResponse& response, PixelPosition star,
                                   Rectangle box);

}  // namespace astroid::test
