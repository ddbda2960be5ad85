// Adds the light of one star to its pixels, on the widest vectors of the processor.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "astroid/core/image.hpp"
#include "gaussian_profiles.hpp"

namespace astroid::detail {

/// Pixels of a stamp within an image: `ny` rows of `nx` from `first` on.
struct StampPixels {
  double* first = nullptr;
  const double* end = nullptr;  ///< of the image's memory: vectors may reach beyond a row, adding nothing, but not here
  std::size_t stride = 0;
  std::size_t nx = 0;
  std::size_t ny = 0;
};

/// The pixels of `box` in an image of contiguous rows that contains it.
inline StampPixels stamp_pixels(const ImageView<double, unit::ExpectedElectrons>& image, const Rectangle& box) {
  return {.first = &image.at(box.x0, box.y0),
          .end = image.data() + image.area().size(),
          .stride = image.stride(),
          .nx = static_cast<std::size_t>(box.nx),
          .ny = static_cast<std::size_t>(box.ny)};
}

inline constexpr std::size_t kLongestProfile = 80;  ///< pixels of a stamp, one axis

/// pixel += (electrons y) x, with the profiles x and y of GaussianProfiles; and the same with the slopes and
/// electrons times `covariance` where that is not 0 (correlated motion of the axes).
struct SeparableStamp {
  GaussianProfiles::Axis x{}, y{};
  GaussianProfiles::Axis x_slope{}, y_slope{};
  double electrons = 0.0;
  double covariance = 0.0;
  std::size_t table_stride = 0;
};
void add_separable_stamp(const SeparableStamp& stamp, const StampPixels& pixels);

/// Nodes of a PRF library that one star is interpolated from, four an axis.
inline constexpr std::size_t kPrfTaps = 16;
/// pixel += electrons sum_k weight_k image_k, in the order of k.
struct PrfStamp {
  std::array<const double*, kPrfTaps> images{};  ///< each from the first pixel of the stamp on
  std::array<double, kPrfTaps> weights{};
  std::size_t image_stride = 0;
  double electrons = 0.0;
};
void add_prf_stamp(const PrfStamp& stamp, const StampPixels& pixels);

namespace reference {
void add_separable_stamp(const SeparableStamp& stamp, const StampPixels& pixels);
void add_prf_stamp(const PrfStamp& stamp, const StampPixels& pixels);
}  // namespace reference

}  // namespace astroid::detail
