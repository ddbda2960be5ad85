// Which of many rectangles touch a query rectangle: a uniform grid of cells, each listing its rectangles.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"

namespace astroid::detail {

/// Immutable once built. Empty rectangles are never found.
class CellGrid {
 public:
  explicit CellGrid(std::span<const Rectangle> rectangles);

  /// Replaces `found` by the indices, ascending, of the rectangles that share a pixel with `query`.
  void find(const Rectangle& query, std::vector<std::size_t>& found) const;

 private:
  struct CellRange {
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;  // cells, the last one included
  };
  [[nodiscard]] CellRange cells_of(const Rectangle& rectangle) const;

  std::span<const Rectangle> rectangles_;
  Rectangle bounds_;
  int cell_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::size_t> first_;  // of cell c in members_
  std::vector<std::size_t> members_;
};

}  // namespace astroid::detail
