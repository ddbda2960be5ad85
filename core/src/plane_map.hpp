// Smooth maps of the plane onto itself, and their inverse by Newton's method.
#pragma once

#include <functional>
#include <optional>

#include "astroid/core/geometry.hpp"

namespace astroid::detail {

/// A map's value at a place, with its derivatives.
struct MapPoint {
  PixelShift value;
  double xx = 1.0;  ///< d value.dx / d x
  double xy = 0.0;  ///< d value.dx / d y
  double yx = 0.0;
  double yy = 1.0;
  [[nodiscard]] double determinant() const { return xx * yy - xy * yx; }
  /// Neither mirrored nor turned by more than a right angle; the trace catches two folds at once.
  [[nodiscard]] bool is_upright() const { return determinant() > 0.0 && xx + yy > 0.0; }
};

/// A map that is the identity near the origin, restricted to the part of the plane that it does not fold: all places
/// for which its Jacobian's determinant and trace are positive on the whole line from the origin to them.
class PlaneMap {
 public:
  using Evaluate = std::function<MapPoint(PixelShift)>;
  explicit PlaneMap(Evaluate evaluate);

  /// Nothing beyond a fold or where the value is not finite.
  [[nodiscard]] std::optional<PixelShift> value(PixelShift place) const;
  /// The place of which `target` is the value.
  [[nodiscard]] std::optional<PixelShift> solve(PixelShift target) const;

 private:
  [[nodiscard]] bool is_unfolded(PixelShift place) const;
  [[nodiscard]] std::optional<PixelShift> newton(PixelShift target, PixelShift start) const;

  Evaluate evaluate_;
  double safe_radius_ = 0.0;  // px; inside it nothing folds
};

}  // namespace astroid::detail
