// Sums over the pixels of stamps, four at a time: the same bits whatever the processor.
#pragma once

#include <hwy/highway.h>

#include <array>

#include "field/padded_plane.hpp"
#include "field/star_stamps.hpp"

namespace astroid::detail {

/// A stamp's derivatives times the weights of its pixels, laid out like the stamp.
struct WeightedStamp {
  float* p = nullptr;
  float* px = nullptr;
  float* py = nullptr;
};

/// Sums over one star's pixels; derivatives with respect to position are those of a star of unit flux.
struct StampSums {
  double pp = 0.0, ppx = 0.0, ppy = 0.0, pxpx = 0.0, pxpy = 0.0, pypy = 0.0;  ///< weighted products
  double rp = 0.0, rpx = 0.0, rpy = 0.0;                                      ///< with the residuals
  double p = 0.0, px = 0.0, py = 0.0;                                         ///< weighted sums
};

StampSums weigh_stamp(const StampView& stamp, const PaddedPlane& weight, const PaddedPlane& residual,
                      const WeightedStamp& out);

/// The nine sums of a weighted stamp's planes with those of another stamp, over the pixels that they share.
std::array<double, 9> pair_sums(const StampView& first, const WeightedStamp& weighted, const StampView& second);

/// Adds flux times the PSF to the pixels of a stamp.
void add_stamp(const StampView& stamp, float flux, PaddedPlane& plane);

}  // namespace astroid::detail
