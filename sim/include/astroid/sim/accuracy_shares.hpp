// How the error that the accuracy allows is shared out.
#pragma once

namespace astroid {

/// Relative to a target's flux tolerance.
struct AccuracyShares {
  double psf = 0.4;     ///< the renderer: phases and interpolation, band
  double stamps = 0.3;  ///< truncation
  double jitter = 0.3;  ///< sampling of the motion
};
inline constexpr AccuracyShares kAccuracyShares;

}  // namespace astroid
