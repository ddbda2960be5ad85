// How a detector is cut into tiles for the sub-pixel renderer.
#pragma once

#include <vector>

#include "astroid/core/image.hpp"

namespace astroid::detail {

struct TileNeeds {
  int sub_pixels = 1;  ///< of the map, per pixel and axis
  int cells = 1;       ///< of the light, per pixel and axis
  int margin = 1;      ///< px around a tile from which light reaches it
  double memory_bytes = 0.0;
};

struct TileGrid {
  std::vector<Rectangle> tiles;  ///< row by row from the detector's first pixel; the last ones may be smaller
  int tile_x = 0, tile_y = 0;    ///< px, of the largest
  int margin = 0;
  int period_x = 0, period_y = 0;  ///< px, of the transforms: tile + 2 margins, or more for a size that is fast
  double workspace_bytes = 0.0;
};

/// The tiles of least work whose maps fit into the memory. @throws InputError when not even those of 8 px do.
TileGrid make_tile_grid(const Rectangle& detector, const TileNeeds& needs);

}  // namespace astroid::detail
