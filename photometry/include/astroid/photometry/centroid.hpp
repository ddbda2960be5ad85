// Where the light of a few pixels is: first moments, with their covariance.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "astroid/core/geometry.hpp"
#include "astroid/photometry/group_fit.hpp"

namespace astroid {

/// NaN where there is none; `flags` says why.
struct Centroid {
  PixelPosition position{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  std::array<double, 3> covariance{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                                   std::numeric_limits<double>::quiet_NaN()};  ///< xx, xy, yy, px²
  double flux = 0.0;                                                           ///< e-, weighted sum
  std::uint32_t flags = 0;  ///< kNoFlux: the sum is not positive, or its light is on both sides of zero so that the
                            ///< place is beyond the pixels; kBadPixel: pixels were left out, which biases a centroid
};

/// C = Σ w x I / Σ w I over the usable pixels, covariance Σ w² (x - C)(x - C)ᵀ V / (Σ w I)², V the variance of a pixel
/// with its photons.
///
/// Exactly the middle of a constant image, and of any that is symmetric about the middle of the box. Of a single pixel
/// it is that pixel, and its covariance is NaN: nothing was measured. A saturated star is no case for moments: charge
/// that is clipped or bled moves them; fit_group() measures its wings.
/// @param weight  of every pixel of the box, at least 0; empty: 1  @thread safe
/// @source F148
[[nodiscard]] Centroid centroid_of(const GroupPixels& pixels, std::span<const double> weight = {});

}  // namespace astroid
