// The kernels of stamp_kernels.hpp, compiled for every instruction set and chosen when the program starts.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vector/stamp_kernels.cpp"
#include "vector/stamp_kernels.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "astroid/core/error.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using detail::GaussianProfiles;
using detail::kLongestProfile;
using detail::PrfStamp;
using detail::SeparableStamp;
using detail::StampPixels;

constexpr std::size_t kDoubles = HWY_LANES(double);
using Doubles = hn::ScalableTag<double>;
using Double = hn::Vec<Doubles>;
using Profile = std::array<double, kLongestProfile + GaussianProfiles::kPadding>;

/// The first `size` pixels of a profile, then zeros up to a whole vector.
HWY_INLINE void profile(const GaussianProfiles::Axis& axis, std::size_t stride, std::size_t size, Profile& out) {
  const Doubles d;
  for (std::size_t i = 0; i < size; i += kDoubles) {
    Double sum = hn::Mul(hn::Set(d, axis.weights[0]), hn::LoadU(d, axis.rows + i));
#pragma GCC unroll 8
    for (std::size_t k = 1; k < GaussianProfiles::kTerms; ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, axis.weights[k]), hn::LoadU(d, axis.rows + k * stride + i)));
    hn::StoreU(sum, d, out.data() + i);
  }
  for (std::size_t i = size; i % kDoubles != 0; ++i) out[i] = 0.0;
}

void separable_kernel(const SeparableStamp& stamp, const StampPixels& pixels) {
  const Doubles d;
  Profile x;
  Profile y;
  Profile x_slope;
  Profile y_slope;
  const bool correlated = stamp.covariance != 0.0;
  profile(stamp.x, stamp.table_stride, pixels.nx, x);
  profile(stamp.y, stamp.table_stride, pixels.ny, y);
  if (correlated) {
    profile(stamp.x_slope, stamp.table_stride, pixels.nx, x_slope);
    profile(stamp.y_slope, stamp.table_stride, pixels.ny, y_slope);
  }
  const double second = stamp.electrons * stamp.covariance;
  const std::size_t padded = (pixels.nx + kDoubles - 1) / kDoubles * kDoubles;
  double* row = pixels.first;
  for (std::size_t j = 0; j < pixels.ny; ++j, row += pixels.stride) {
    const double weight = stamp.electrons * y[j];
    const double slope_weight = correlated ? second * y_slope[j] : 0.0;
    if (HWY_LIKELY(static_cast<std::size_t>(pixels.end - row) >= padded)) {
      const Double w = hn::Set(d, weight);
      const Double ws = hn::Set(d, slope_weight);
      for (std::size_t i = 0; i < padded; i += kDoubles) {
        Double light = hn::Mul(w, hn::LoadU(d, x.data() + i));
        if (correlated) light = hn::Add(light, hn::Mul(ws, hn::LoadU(d, x_slope.data() + i)));
        hn::StoreU(hn::Add(hn::LoadU(d, row + i), light), d, row + i);
      }
    } else {
      for (std::size_t i = 0; i < pixels.nx; ++i) {
        double light = weight * x[i];
        if (correlated) light = light + slope_weight * x_slope[i];
        row[i] = row[i] + light;
      }
    }
  }
}

void prf_kernel(const PrfStamp& stamp, const StampPixels& pixels) {
  const Doubles d;
  const Double electrons = hn::Set(d, stamp.electrons);
  double* row = pixels.first;
  for (std::size_t j = 0; j < pixels.ny; ++j, row += pixels.stride) {
    const std::size_t from = j * stamp.image_stride;
    std::size_t i = 0;
    for (; i + kDoubles <= pixels.nx; i += kDoubles) {
      Double sum = hn::Mul(hn::Set(d, stamp.weights[0]), hn::LoadU(d, stamp.images[0] + from + i));
#pragma GCC unroll 16
      for (std::size_t k = 1; k < detail::kPrfTaps; ++k)
        sum = hn::Add(sum, hn::Mul(hn::Set(d, stamp.weights[k]), hn::LoadU(d, stamp.images[k] + from + i)));
      const Double light = hn::Mul(electrons, hn::Max(sum, hn::Zero(d)));
      hn::StoreU(hn::Add(hn::LoadU(d, row + i), light), d, row + i);
    }
    for (; i < pixels.nx; ++i) {
      double sum = stamp.weights[0] * stamp.images[0][from + i];
      for (std::size_t k = 1; k < detail::kPrfTaps; ++k) sum = sum + stamp.weights[k] * stamp.images[k][from + i];
      row[i] = row[i] + stamp.electrons * std::max(sum, 0.0);
    }
  }
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astroid {

namespace {

HWY_EXPORT(separable_kernel);
HWY_EXPORT(prf_kernel);

double profile_at(const detail::GaussianProfiles::Axis& axis, std::size_t stride, std::size_t i) {
  double sum = axis.weights[0] * axis.rows[i];
  for (std::size_t k = 1; k < detail::GaussianProfiles::kTerms; ++k)
    sum = sum + axis.weights[k] * axis.rows[k * stride + i];
  return sum;
}

}  // namespace

void detail::add_separable_stamp(const SeparableStamp& stamp, const StampPixels& pixels) {
  ASTROID_CHECK_LE(pixels.nx, kLongestProfile);
  ASTROID_CHECK_LE(pixels.ny, kLongestProfile);
  HWY_DYNAMIC_DISPATCH(separable_kernel)(stamp, pixels);
}

void detail::add_prf_stamp(const PrfStamp& stamp, const StampPixels& pixels) {
  HWY_DYNAMIC_DISPATCH(prf_kernel)(stamp, pixels);
}

void detail::reference::add_separable_stamp(const SeparableStamp& stamp, const StampPixels& pixels) {
  for (std::size_t j = 0; j < pixels.ny; ++j)
    for (std::size_t i = 0; i < pixels.nx; ++i) {
      double light =
          stamp.electrons * profile_at(stamp.y, stamp.table_stride, j) * profile_at(stamp.x, stamp.table_stride, i);
      if (stamp.covariance != 0.0)
        light = light + stamp.electrons * stamp.covariance * profile_at(stamp.y_slope, stamp.table_stride, j) *
                            profile_at(stamp.x_slope, stamp.table_stride, i);
      double& pixel = pixels.first[j * pixels.stride + i];
      pixel = pixel + light;
    }
}

void detail::reference::add_prf_stamp(const PrfStamp& stamp, const StampPixels& pixels) {
  for (std::size_t j = 0; j < pixels.ny; ++j)
    for (std::size_t i = 0; i < pixels.nx; ++i) {
      const std::size_t at = j * stamp.image_stride + i;
      double sum = stamp.weights[0] * stamp.images[0][at];
      for (std::size_t k = 1; k < kPrfTaps; ++k) sum = sum + stamp.weights[k] * stamp.images[k][at];
      double& pixel = pixels.first[j * pixels.stride + i];
      pixel = pixel + stamp.electrons * std::max(sum, 0.0);
    }
}

}  // namespace astroid
#endif
