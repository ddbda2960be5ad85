// The kernels of plane_kernels.hpp, compiled for every instruction set and chosen when the program starts.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vector/plane_kernels.cpp"
#include "astroid/core/plane_kernels.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstddef>

#include "astroid/core/error.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

std::size_t find_at_least_kernel(const double* values, std::size_t size, double limit, std::uint32_t* found) {
  const hn::ScalableTag<double> d;
  const auto bound = hn::Set(d, limit);
  constexpr std::size_t kAtOnce = 4 * HWY_LANES(double);
  std::size_t count = 0;
  std::size_t i = 0;
  const auto one_by_one = [&](std::size_t end) {
    for (; i < end; ++i) {
      found[count] = static_cast<std::uint32_t>(i);
      count += values[i] >= limit ? 1U : 0U;
    }
  };
  while (i + kAtOnce <= size) {
    auto any = hn::Ge(hn::LoadU(d, values + i), bound);
    for (std::size_t k = 1; k < 4; ++k)
      any = hn::Or(any, hn::Ge(hn::LoadU(d, values + i + k * HWY_LANES(double)), bound));
    if (HWY_LIKELY(hn::AllFalse(d, any)))
      i += kAtOnce;
    else
      one_by_one(i + kAtOnce);
  }
  one_by_one(size);
  return count;
}

void add_constant_kernel(double* values, std::size_t size, double constant) {
  const hn::ScalableTag<double> d;
  const auto c = hn::Set(d, constant);
  std::size_t i = 0;
  for (; i + HWY_LANES(double) <= size; i += HWY_LANES(double))
    hn::StoreU(hn::Add(hn::LoadU(d, values + i), c), d, values + i);
  for (; i < size; ++i) values[i] += constant;
}

void add_values_kernel(double* values, std::size_t size, const float* other) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> half;
  std::size_t i = 0;
  for (; i + HWY_LANES(double) <= size; i += HWY_LANES(double))
    hn::StoreU(hn::Add(hn::LoadU(d, values + i), hn::PromoteTo(d, hn::LoadU(half, other + i))), d, values + i);
  for (; i < size; ++i) values[i] += static_cast<double>(other[i]);
}

void multiply_values_kernel(double* values, std::size_t size, const float* other) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> half;
  std::size_t i = 0;
  for (; i + HWY_LANES(double) <= size; i += HWY_LANES(double))
    hn::StoreU(hn::Mul(hn::LoadU(d, values + i), hn::PromoteTo(d, hn::LoadU(half, other + i))), d, values + i);
  for (; i < size; ++i) values[i] *= static_cast<double>(other[i]);
}

void scale_values_kernel(const double* values, std::size_t size, double factor, double* out) {
  const hn::ScalableTag<double> d;
  const auto f = hn::Set(d, factor);
  std::size_t i = 0;
  for (; i + HWY_LANES(double) <= size; i += HWY_LANES(double))
    hn::StoreU(hn::Mul(hn::LoadU(d, values + i), f), d, out + i);
  for (; i < size; ++i) out[i] = values[i] * factor;
}

void combine_maps_kernel(const double* base, const float* const* maps, const float* weights, std::size_t count,
                         std::size_t size, double* out) {
  const hn::ScalableTag<float> d;
  const hn::Half<decltype(d)> half;
  const hn::ScalableTag<double> dd;
  constexpr std::size_t kSingles = HWY_LANES(float);
  constexpr std::size_t kDoubles = HWY_LANES(double);
  std::size_t i = 0;
  for (; i + kSingles <= size; i += kSingles) {
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < count; ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, maps[k] + i)));
    const auto lower = hn::PromoteTo(dd, hn::LowerHalf(half, sum));
    const auto upper = hn::PromoteTo(dd, hn::UpperHalf(half, sum));
    // The larger of the two in this order leaves a NaN as it is.
    const auto none = hn::Zero(dd);
    hn::StoreU(hn::Max(none, hn::Add(hn::LoadU(dd, base + i), lower)), dd, out + i);
    hn::StoreU(hn::Max(none, hn::Add(hn::LoadU(dd, base + i + kDoubles), upper)), dd, out + i + kDoubles);
  }
  for (; i < size; ++i) {
    float sum = 0.0F;
    for (std::size_t k = 0; k < count; ++k) sum = sum + weights[k] * maps[k][i];
    const double value = base[i] + static_cast<double>(sum);
    out[i] = 0.0 > value ? 0.0 : value;
  }
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astroid {

namespace {
HWY_EXPORT(find_at_least_kernel);
HWY_EXPORT(combine_maps_kernel);
HWY_EXPORT(add_constant_kernel);
HWY_EXPORT(add_values_kernel);
HWY_EXPORT(multiply_values_kernel);
HWY_EXPORT(scale_values_kernel);
}  // namespace

void add_constant(std::span<double> values, double constant) {
  HWY_DYNAMIC_DISPATCH(add_constant_kernel)(values.data(), values.size(), constant);
}

void add_values(std::span<double> values, std::span<const float> other) {
  ASTROID_CHECK_EQ(values.size(), other.size());
  HWY_DYNAMIC_DISPATCH(add_values_kernel)(values.data(), values.size(), other.data());
}

void multiply_values(std::span<double> values, std::span<const float> other) {
  ASTROID_CHECK_EQ(values.size(), other.size());
  HWY_DYNAMIC_DISPATCH(multiply_values_kernel)(values.data(), values.size(), other.data());
}

void scale_values(std::span<const double> values, double factor, std::span<double> out) {
  ASTROID_CHECK_EQ(values.size(), out.size());
  HWY_DYNAMIC_DISPATCH(scale_values_kernel)(values.data(), values.size(), factor, out.data());
}

std::size_t find_at_least(std::span<const double> values, double limit, std::span<std::uint32_t> found) {
  ASTROID_CHECK_LE(values.size(), found.size());
  return HWY_DYNAMIC_DISPATCH(find_at_least_kernel)(values.data(), values.size(), limit, found.data());
}

void combine_maps(std::span<const double> base, std::span<const float* const> maps, std::span<const float> weights,
                  std::span<double> out) {
  ASTROID_CHECK_EQ(base.size(), out.size());
  ASTROID_CHECK_EQ(maps.size(), weights.size());
  HWY_DYNAMIC_DISPATCH(combine_maps_kernel)
  (base.data(), maps.data(), weights.data(), maps.size(), out.size(), out.data());
}

void reference::add_constant(std::span<double> values, double constant) {
  for (double& value : values) value += constant;
}

void reference::add_values(std::span<double> values, std::span<const float> other) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += static_cast<double>(other[i]);
}

void reference::multiply_values(std::span<double> values, std::span<const float> other) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= static_cast<double>(other[i]);
}

void reference::scale_values(std::span<const double> values, double factor, std::span<double> out) {
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i] * factor;
}

std::size_t reference::find_at_least(std::span<const double> values, double limit, std::span<std::uint32_t> found) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] >= limit) found[count++] = static_cast<std::uint32_t>(i);
  return count;
}

void reference::combine_maps(std::span<const double> base, std::span<const float* const> maps,
                             std::span<const float> weights, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    float sum = 0.0F;
    for (std::size_t k = 0; k < maps.size(); ++k) sum = sum + weights[k] * maps[k][i];
    const double value = base[i] + static_cast<double>(sum);
    out[i] = 0.0 > value ? 0.0 : value;
  }
}

}  // namespace astroid
#endif
