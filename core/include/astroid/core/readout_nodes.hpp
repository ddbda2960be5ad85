// The nodes through which a detector is read: which pixel goes through which.
#pragma once

#include "astroid/core/image.hpp"

namespace astroid {

inline constexpr int kMostNodes = 4;

/// Detectors are read through one node, two (left and right half of each row) or four (quadrants). Node numbers count
/// from 0: left, right, upper left, upper right. Reference pixels go through the node of the nearest half. With four
/// nodes the rows of the upper half are moved upwards, to a register above the last row.
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

  /// Whether the two halves of a column are read in opposite directions.
  [[nodiscard]] bool splits_columns() const { return nodes_ == 4; }
  /// Parts of a column that are read in one direction: 1 or 2, counted from below.
  [[nodiscard]] int halves() const { return splits_columns() ? 2 : 1; }
  /// Which of them a row belongs to; overscan rows to the nearest.
  [[nodiscard]] int half_of(int y) const { return splits_columns() && y >= middle_y_ ? 1 : 0; }
  /// Its light-sensitive pixels. @param detector  as given to the constructor.
  [[nodiscard]] Rectangle half(const Rectangle& detector, int number) const {
    if (!splits_columns()) return detector;
    return number == 0 ? Rectangle{detector.x0, detector.y0, detector.nx, middle_y_ - detector.y0}
                       : Rectangle{detector.x0, middle_y_, detector.nx, detector.y1() - middle_y_};
  }

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
