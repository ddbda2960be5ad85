// An image without its background, filtered, in units of the filtered noise.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/photometry/background.hpp"

namespace astroid::detail {

/// Product of a column and a row, both of sum 1 and of odd length.
struct FilterKernel {
  std::vector<float> column, row;
  [[nodiscard]] double norm() const;  ///< root of the sum of squares of its elements
};

[[nodiscard]] FilterKernel gaussian_kernel(double fwhm);

/// Values with a margin of one pixel of very low ones, so that no neighbour needs a check.
class SmoothImage {
 public:
  SmoothImage(const Frame& frame, const BackgroundMap& background, const FilterKernel& kernel);

  [[nodiscard]] int nx() const { return nx_; }
  [[nodiscard]] int ny() const { return ny_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * stride_ + static_cast<std::size_t>(x + 1);
  }
  [[nodiscard]] std::span<const float> values() const { return values_; }
  [[nodiscard]] float at(int x, int y) const { return values_[index(x, y)]; }

 private:
  int nx_;
  int ny_;
  std::size_t stride_;
  std::vector<float> values_;
};

}  // namespace astroid::detail
