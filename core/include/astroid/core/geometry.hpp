// Positions and directions.
#pragma once

namespace astroid {

/// 0-based detector pixel coordinates; the centre of the first pixel is (0, 0).
struct PixelPosition {
  double x = 0.0;
  double y = 0.0;
};

/// ICRS direction in degrees.
struct SkyPosition {
  double ra = 0.0;   ///< [0, 360)
  double dec = 0.0;  ///< [-90, 90]
};

/// A displacement on the detector, in pixels.
struct PixelShift {
  double dx = 0.0;
  double dy = 0.0;
};

}  // namespace astroid
