// The kernels of charge_kernels.hpp, compiled for every instruction set and chosen when the program starts.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vector/charge_kernels.cpp"
#include "astroid/core/charge_kernels.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "astroid/core/error.hpp"
#include "vector/charge_fits.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using Double = hn::Vec<Doubles>;
constexpr std::size_t kDoubles = HWY_LANES(double);

template <std::size_t N>
HWY_INLINE Double polynomial(Double x, const std::array<double, N>& coefficient) {
  const Doubles d;
  Double sum = hn::Set(d, coefficient[N - 1]);
#pragma GCC unroll 16
  for (std::size_t i = 2; i <= N; ++i) sum = hn::Add(hn::Mul(sum, x), hn::Set(d, coefficient[N - i]));
  return sum;
}

/// ln x of a normal number above 0.
HWY_INLINE Double log_of(Double x) {
  const Doubles d;
  const hn::RebindToUnsigned<Doubles> u;
  const auto shifted = hn::Add(hn::BitCast(u, x), hn::Set(u, charge_fits::kOneBits - charge_fits::kSqrtHalfBits));
  const auto biased = hn::ShiftRight<charge_fits::kMantissaBits>(shifted);
  const Double exponent = hn::Sub(hn::BitCast(d, hn::Add(biased, hn::Set(u, charge_fits::kRounderBits))),
                                  hn::Set(d, charge_fits::kRounder + charge_fits::kExponentBias));
  const Double mantissa = hn::BitCast(
      d, hn::Add(hn::And(shifted, hn::Set(u, charge_fits::kMantissaMask)), hn::Set(u, charge_fits::kSqrtHalfBits)));
  const Double one = hn::Set(d, 1.0);
  const Double s = hn::Div(hn::Sub(mantissa, one), hn::Add(mantissa, one));
  return hn::Add(hn::Mul(exponent, hn::Set(d, charge_fits::kLn2)),
                 hn::Mul(s, polynomial(hn::Mul(s, s), charge_fits::kLog)));
}

/// e^x, |x| < 700.
HWY_INLINE Double exp_of(Double x) {
  const Doubles d;
  const hn::RebindToUnsigned<Doubles> u;
  const Double rounder = hn::Set(d, charge_fits::kRounder);
  const Double shifted = hn::Add(hn::Mul(x, hn::Set(d, charge_fits::kLog2E)), rounder);
  const Double k = hn::Sub(shifted, rounder);
  const Double r =
      hn::Sub(hn::Sub(x, hn::Mul(k, hn::Set(d, charge_fits::kLn2High))), hn::Mul(k, hn::Set(d, charge_fits::kLn2Low)));
  const auto scale =
      hn::Add(hn::ShiftLeft<charge_fits::kMantissaBits>(hn::BitCast(u, shifted)), hn::Set(u, charge_fits::kOneBits));
  return hn::Mul(polynomial(r, charge_fits::kExp), hn::BitCast(d, scale));
}

HWY_INLINE void pass(const TrapPassage& passage, double* charge, double* filled) {
  const Doubles d;
  const Double q = hn::LoadU(d, charge);
  const Double n = hn::LoadU(d, filled);
  const Double one = hn::Set(d, 1.0);
  const Double gamma = hn::Set(d, passage.traps);
  const auto some = hn::Gt(q, hn::Set(d, charge_fits::kLeastCharge));
  const Double packet = hn::IfThenElse(some, q, one);
  const Double volume = exp_of(hn::Mul(hn::Set(d, passage.volume_power), log_of(packet)));
  const Double reach = hn::Mul(gamma, volume);
  const Double share = hn::Div(packet, hn::Add(reach, packet));
  const Double exponent = hn::Max(hn::Div(hn::Mul(hn::Set(d, -passage.capture_rate), packet), volume),
                                  hn::Set(d, charge_fits::kLeastExponent));
  const Double room = hn::Mul(hn::Sub(reach, n), share);
  const Double wanted = hn::Mul(hn::Max(room, hn::Zero(d)), hn::Sub(one, exp_of(exponent)));
  const Double captured = hn::IfThenElseZero(some, wanted);
  const Double held = hn::Add(n, captured);
  const Double released = hn::Mul(held, hn::Set(d, passage.released));
  hn::StoreU(hn::Sub(held, released), d, filled);
  hn::StoreU(hn::Add(hn::Sub(q, captured), released), d, charge);
}

void pass_traps_kernel(const TrapPassage& passage, double* charge, double* filled, std::size_t size) {
  std::size_t i = 0;
  for (; i + kDoubles <= size; i += kDoubles) pass(passage, charge + i, filled + i);
  if (i == size) return;
  HWY_ALIGN std::array<double, kDoubles> charges{};
  HWY_ALIGN std::array<double, kDoubles> fillings{};
  std::copy(charge + i, charge + size, charges.begin());
  std::copy(filled + i, filled + size, fillings.begin());
  pass(passage, charges.data(), fillings.data());
  std::copy_n(charges.begin(), size - i, charge + i);
  std::copy_n(fillings.begin(), size - i, filled + i);
}

void add_scaled_kernel(double* values, double factor, const double* other, std::size_t size) {
  const Doubles d;
  const Double f = hn::Set(d, factor);
  std::size_t i = 0;
  for (; i + kDoubles <= size; i += kDoubles)
    hn::StoreU(hn::Add(hn::LoadU(d, values + i), hn::Mul(f, hn::LoadU(d, other + i))), d, values + i);
  for (; i < size; ++i) values[i] = values[i] + factor * other[i];
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astroid {

namespace {
HWY_EXPORT(pass_traps_kernel);
HWY_EXPORT(add_scaled_kernel);
}  // namespace

void add_scaled(std::span<double> values, double factor, std::span<const double> other) {
  ASTROID_CHECK_EQ(values.size(), other.size());
  HWY_DYNAMIC_DISPATCH(add_scaled_kernel)(values.data(), factor, other.data(), values.size());
}

void pass_traps(const TrapPassage& passage, std::span<double> charge, std::span<double> filled) {
  ASTROID_CHECK_EQ(charge.size(), filled.size());
  HWY_DYNAMIC_DISPATCH(pass_traps_kernel)(passage, charge.data(), filled.data(), charge.size());
}

}  // namespace astroid
#endif
