// Which pixels of a layout follow each other on the way to the register, and along it.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
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

/// Moves the rows of every exposed region towards the register below row 0. Overscan rows behind the last row follow
/// those columns of the last region that reaches it.
/// @param regions  exposed ones first.  @returns electrons that come out behind the regions.
double move_rows(std::span<const ChargeRegion> regions, std::size_t exposed, const Rectangle& detector,
                 const MoveChain& move);

/// Moves the columns of every exposed region, and of overscan rows, along the register: towards lower columns or, right
/// of `middle`, towards higher ones. Overscan columns follow the last column where it moves to the left.
/// @param before  elements of the register that every packet passes before the first column's place (prescan).
double move_columns(std::span<const ChargeRegion> regions, std::size_t exposed, const Rectangle& detector, int middle,
                    int before, const MoveChain& move);

}  // namespace astroid
