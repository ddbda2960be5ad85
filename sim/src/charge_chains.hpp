// Which pixels of a layout follow each other on the way to the register, and along it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/sim/charge_transfer.hpp"

namespace astroid {

/// A region of a layout and where its pixels are.
struct ChargeRegion {
  Rectangle area;
  double* pixels = nullptr;  ///< row by row
  [[nodiscard]] double* at(int x, int y) const {
    return pixels + static_cast<std::size_t>(y - area.y0) * static_cast<std::size_t>(area.nx) + (x - area.x0);
  }
};

/// Moves a chain; returns what comes out behind it.
using MoveChain = std::function<double(const TransferChain&)>;

/// An exposed region whose charge trails into overscan pixels: the rows behind the last one for columns of `valid`, or
/// the columns behind the last one for its rows. Where several can, the first does.
struct TrailSource {
  std::size_t region = 0;
  Rectangle valid;
};

/// The pixels of a layout and where charge trails out of the exposed ones.
struct ChargePixels {
  Rectangle detector;
  std::vector<ChargeRegion> regions;  ///< exposed ones first
  std::size_t exposed = 0;
  std::vector<TrailSource> into_rows;
  std::vector<TrailSource> into_columns;
};

/// Moves the rows of every exposed region towards the register below row 0, and overscan rows behind their source.
/// @returns electrons that come out behind the regions.
double move_rows(const ChargePixels& pixels, const MoveChain& move);

/// Moves the columns of every exposed region, and of overscan rows, along the register: towards lower columns or, from
/// `middle` on, towards higher ones. Overscan columns follow their source.
/// @param before  elements of the register that every packet passes before the first column's place (prescan).
double move_columns(const ChargePixels& pixels, int middle, int before, const MoveChain& move);

}  // namespace astroid
