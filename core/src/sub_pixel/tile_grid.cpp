#include "sub_pixel/tile_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "sub_pixel/fourier_transform.hpp"

namespace astroid::detail {

namespace {

constexpr int kSmallestTile = 8;  // px

// Real and complex numbers of the map and of the cells.
double bytes_of(double period_x, double period_y, const TileNeeds& needs) {
  constexpr double kNode = sizeof(double) + 0.5 * 2.0 * sizeof(double);
  const double map = static_cast<double>(needs.sub_pixels) * needs.sub_pixels;
  const double cells = static_cast<double>(needs.cells) * needs.cells;
  return kNode * (map + cells) * period_x * period_y;
}

struct Axis {
  int tile = 0;
  int period = 0;
};

// The tile of least work along one axis among those whose period is at most `longest`.
Axis choose_axis(int length, int margin, int longest) {
  Axis best;
  double least = std::numeric_limits<double>::infinity();
  for (int tiles = 1; tiles <= length; ++tiles) {
    const int tile = (length + tiles - 1) / tiles;
    const auto period = static_cast<int>(FourierTransform::good_size(static_cast<std::size_t>(tile + 2 * margin)));
    if (period <= longest) {
      const double work = static_cast<double>(tiles) * period;
      if (work < least) {
        least = work;
        best = {tile, period};
      }
    }
    if (tile <= std::min(kSmallestTile, length)) break;
  }
  return best;
}

}  // namespace

TileGrid make_tile_grid(const Rectangle& detector, const TileNeeds& needs) {
  const double side = std::sqrt(needs.memory_bytes / bytes_of(1.0, 1.0, needs));
  constexpr double kLongest = 1e6;
  const auto longest = static_cast<int>(std::min(side, kLongest));
  // A narrow detector leaves memory for longer tiles.
  const Axis narrow = choose_axis(std::min(detector.nx, detector.ny), needs.margin, longest);
  const auto other = narrow.period > 0 ? static_cast<int>(std::min(side * side / narrow.period, kLongest)) : 0;
  const Axis wide = choose_axis(std::max(detector.nx, detector.ny), needs.margin, other);
  if (narrow.period == 0 || wide.period == 0) {
    const double period = kSmallestTile + 2.0 * needs.margin;
    throw InputError(
        Problem{.parameter = "Simulation/Renderer",
                .value = "subpixel",
                .expected = "fewer sub-pixels or a PSF of smaller extent",
                .message = fmt::format("the smallest tile needs {:.3g} MB, {:.3g} MB are allowed",
                                       1e-6 * bytes_of(period, period, needs), 1e-6 * needs.memory_bytes)});
  }
  const bool x_is_narrow = detector.nx <= detector.ny;
  const Axis x = x_is_narrow ? narrow : wide;
  const Axis y = x_is_narrow ? wide : narrow;
  TileGrid grid{.tiles = {},
                .tile_x = x.tile,
                .tile_y = y.tile,
                .margin = needs.margin,
                .period_x = x.period,
                .period_y = y.period,
                .workspace_bytes = bytes_of(x.period, y.period, needs)};
  for (int y0 = detector.y0; y0 < detector.y1(); y0 += y.tile)
    for (int x0 = detector.x0; x0 < detector.x1(); x0 += x.tile)
      grid.tiles.push_back(intersect(detector, {x0, y0, x.tile, y.tile}));
  return grid;
}

}  // namespace astroid::detail
