// A disc over pixels.
#pragma once

#include "astroid/core/geometry.hpp"

namespace astroid {

/// Area of pixel (x, y) that a disc covers, px²: 0 to 1, continuous in the disc's position and radius.
/// @param radius  px, >= 0
/// @accuracy 1e-12 for radii up to 1e4 px (test: Disc.CoversItsArea)
[[nodiscard]] double disc_coverage(PixelPosition centre, double radius, int x, int y);

}  // namespace astroid
