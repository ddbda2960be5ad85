// The reference pixels that a FITS file holds beside its image.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "astroid/core/fits.hpp"
#include "astroid/core/frame.hpp"

namespace astroid::detail {

/// Mean of the prescan columns of an image (extensions PRESCAN) without hits by particles, or nothing where there are
/// none.
/// @param header  gain and readout noise of the image.
std::optional<Adu> prescan_level(const FitsReader& reader, int image_unit, const FrameHeader& header);

/// Subtracts what overscan rows say is smeared into the columns of an image; its bias, that of its header, stays.
///
/// Extensions OVERSCAN (rows above the image, and perhaps below it for its lower half) are found by name, and their
/// place by LTV1 and LTV2, which the image has too (0 where it has not).
/// @param frame  one region, from (0, 0).
/// @param notes  gains what was done, or why it was not.
void subtract_overscan(const FitsReader& reader, int image_unit, Frame& frame, std::vector<std::string>& notes);

}  // namespace astroid::detail
