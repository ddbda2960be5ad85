// Smooth interpolation between places of the field: weights of tables at a position.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/psf.hpp"

namespace astroid::detail {

/// Cardinal functions of the thin-plate spline through the nodes: smooth, exact at the nodes and for anything linear in
/// position, summing to 1 everywhere. Nodes on one line (or fewer than three) are interpolated by distance instead:
/// linearly along the line. Beyond the box around the nodes the nearest place in it counts.
/// @source Duchon1977
class FieldWeights {
 public:
  /// @param nodes  distinct; at least one
  explicit FieldWeights(std::vector<PixelPosition> nodes);

  /// @param weights  [out] one for each node.
  void at(PixelPosition position, std::span<double> weights) const;
  /// Derivatives with respect to the position, 1/px.
  void gradient(PixelPosition position, std::span<double> along_x, std::span<double> along_y) const;

  [[nodiscard]] const std::vector<PixelPosition>& nodes() const { return nodes_; }

 private:
  bool solve(bool thin_plate);
  [[nodiscard]] PixelPosition inside(PixelPosition position) const;

  std::vector<PixelPosition> nodes_;
  PixelPosition lower_, upper_;
  double scale_ = 1.0;  // 1/px: brings the box to size 1
  bool thin_plate_ = true;
  std::size_t rows_ = 0;         // basis functions: one a node, and 1 or 1, x, y
  std::vector<double> inverse_;  // (rows, nodes)
};

/// @throws InputError when there is no table, or one has no place, or two share one.
void require_field(std::span<const FieldPsfTable> tables);

}  // namespace astroid::detail
