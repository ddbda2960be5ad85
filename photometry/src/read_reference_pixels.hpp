// The reference pixels that a FITS file holds beside its image.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "astroid/core/fits.hpp"
#include "astroid/core/frame.hpp"

namespace astroid::detail {

/// Subtracts what overscan rows say is smeared into the columns of an image; its bias stays.
///
/// Extensions OVERSCAN (rows above the image, and perhaps below it for its lower half) and PRESCAN (columns left of it)
/// are found by name, and their place by LTV1 and LTV2, which the image has too (0 where it has not). The bias is
/// `bias` or the mean of the prescan, else BIAS of the header, else 0, which then is the level that the image is left
/// with.
/// @param frame  one region, from (0, 0).
/// @param notes  gains what was done, or why it was not.
void subtract_overscan(const FitsReader& reader, int image_unit, const std::optional<Adu>& bias, Frame& frame,
                       std::vector<std::string>& notes);

}  // namespace astroid::detail
