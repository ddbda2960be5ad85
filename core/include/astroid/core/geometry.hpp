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

/// Covariance of a displacement on the detector, px².
struct MotionCovariance {
  double sxx = 0.0;
  double sxy = 0.0;
  double syy = 0.0;
  /// Variance of gx dx + gy dy.
  [[nodiscard]] double along(double gx, double gy) const { return gx * gx * sxx + 2.0 * gx * gy * sxy + gy * gy * syy; }
};

}  // namespace astroid
