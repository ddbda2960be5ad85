// The nodes through which a detector is read: which pixel goes through which.
#pragma once

#include "astroid/core/image.hpp"

namespace astroid {

inline constexpr int kMostNodes = 4;

/// Detectors are read through one node, two (left and right half of each row) or four (quadrants). Node numbers count
/// from 0: left, right, upper left, upper right. Reference pixels go through the node of the nearest half.
///
/// @throws nothing; `nodes` other than 2 and 4 count as one node.
class ReadoutNodes {
 public:
  ReadoutNodes(const Rectangle& detector, int nodes)
      : middle_x_(detector.x0 + (detector.nx + 1) / 2), middle_y_(detector.y0 + (detector.ny + 1) / 2), nodes_(nodes) {}

  [[nodiscard]] int count() const { return nodes_ == 2 || nodes_ == 4 ? nodes_ : 1; }
  [[nodiscard]] int of(int x, int y) const {
    if (count() == 1) return 0;
    return (x >= middle_x_ ? 1 : 0) + (nodes_ == 4 && y >= middle_y_ ? 2 : 0);
  }
  /// First column of the right half; beyond every column where there is one node a row.
  [[nodiscard]] int middle_x() const { return middle_x_; }
  [[nodiscard]] int middle_y() const { return middle_y_; }

 private:
  int middle_x_;
  int middle_y_;
  int nodes_;
};

/// Calls visit(node, first column, one past the last) for the one or two stretches of a row between columns x0 and x1.
template <class Visit>
void for_each_node(const ReadoutNodes& nodes, int y, int x0, int x1, Visit&& visit) {
  const int middle = nodes.count() == 1 ? x1 : nodes.middle_x();
  if (x0 < middle && x0 < x1) visit(nodes.of(x0, y), x0, middle < x1 ? middle : x1);
  if (middle < x1) visit(nodes.of(middle > x0 ? middle : x0, y), middle > x0 ? middle : x0, x1);
}

}  // namespace astroid
