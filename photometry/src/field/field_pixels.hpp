// The pixels of a frame as what a field is fitted to.
#pragma once

#include "astroid/core/frame.hpp"
#include "astroid/photometry/background.hpp"
#include "field/field_solver.hpp"

namespace astroid::detail {

/// Electrons, weights and first sky of region 0, with a margin of `pad` px. Pixels that are flagged or not finite are
/// not usable; the noise is that of the header, or measured where the header has none or much too little.
FieldPixels field_pixels(const Frame& frame, const MeshSettings& settings, int pad);

}  // namespace astroid::detail
