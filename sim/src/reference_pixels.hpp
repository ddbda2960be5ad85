// Which reference pixels are read with the exposed ones.
#pragma once

#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/mission.hpp"

namespace astroid {

/// Prescan and serial overscan of the rows of the exposed regions, parallel overscan of their columns; rows and columns
/// that several regions share are there once.
std::vector<Rectangle> reference_regions(std::span<const Rectangle> exposed, const Rectangle& detector,
                                         const ReferencePixels& reference);

}  // namespace astroid
