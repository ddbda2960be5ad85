// Circular apertures with exact pixel overlap.
#pragma once

#include <span>

#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"

namespace astroid {

/// Area that a disc of `radius` around the origin shares with the rectangle [x0, x1] × [y0, y1], in px².
///
/// Uses only + - × ÷ √, so its bits do not depend on the processor.
/// @accuracy  1e-14 max(1, radius) px², for pixel-sized rectangles of any position and any radius.
/// @valid     x0 <= x1, y0 <= y1, radius >= 0, all finite.
[[nodiscard]] double disc_rectangle_overlap(double radius, double x0, double x1, double y0, double y1);

/// The pixels that a circular aperture can touch. Empty unless position and radius are finite and the radius > 0.
[[nodiscard]] Rectangle aperture_box(PixelPosition centre, double radius);

/// Share of each pixel of `box` that lies inside a circular aperture, row by row.
/// @param overlap  [out] shape (box.ny, box.nx), in [0, 1].
void aperture_overlap(PixelPosition centre, double radius, const Rectangle& box, std::span<double> overlap);

}  // namespace astroid
