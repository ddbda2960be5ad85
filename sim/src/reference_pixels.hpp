// Which reference pixels are read with the exposed ones.
#pragma once

#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/mission.hpp"

namespace astroid {

/// Prescan and serial overscan of the rows of the exposed regions, parallel overscan of their columns; rows and columns
/// that several regions share are there once. Where four nodes read the halves of a column in opposite directions, each
/// half has its overscan, that of the lower one below the first row.
std::vector<Rectangle> reference_regions(std::span<const Rectangle> exposed, const Rectangle& detector,
                                         const ReferencePixels& reference, int nodes);

}  // namespace astroid
