// How much more the light of an aperture bends with motion where brighter stars are near.
#pragma once

#include <span>

#include "astroid/core/psf.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Factor by which the second order of a motion matters more in a scene than it does for the brightest target alone:
/// the largest, over targets, of the curvature of the light in their apertures, neighbours included, relative to that
/// light, over the PSF's own, weighed by how much error each target is allowed.
///
/// A star's wing is steeper than its core: a mask in it sees little light that bends much. Masks of 3 and 5 px; light
/// is taken from below and curvature from above over places in the pixel, directions, and distances up to half a pixel
/// off. Targets that saturate are left out, saturated neighbours are not.
/// @param is_target  of each star
/// @return at least 1.  @complexity  O(stars × neighbours within the stamp of a star)
double neighbour_curvature(std::span<const SceneStar> stars, const std::vector<bool>& is_target, const PixelPsf& psf,
                           const SceneSummary& summary);

}  // namespace astroid
