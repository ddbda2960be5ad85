// Smooth light over the detector.
#pragma once

#include <array>

#include "astroid/core/image.hpp"
#include "astroid/sim/strip.hpp"

namespace astroid {

/// A level that is bilinear between the outer corners of the detector; a pixel has that of its centre.
class BilinearLight {
 public:
  /// @param corners  e- per pixel at the lower left, lower right, upper left and upper right.
  BilinearLight(const Rectangle& detector, const std::array<double, 4>& corners);

  /// Level in a row: first + slope * x.
  struct Row {
    double first, slope;
  };
  [[nodiscard]] Row row(int y) const { return {constant_ + y_ * y, x_ + xy_ * y}; }

 private:
  double constant_, x_, y_, xy_;
};

/// Adds the light to the pixels of a strip: by detector pixel, so a window has what the full frame has.
void add_light(const BilinearLight& light, const Strip& strip, StripPlane<double, unit::ExpectedElectrons>& expected);

}  // namespace astroid
