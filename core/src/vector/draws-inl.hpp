// Random words to normals and Poisson counts, a vector at a time. Included once for every instruction set (Highway's
// scheme). Each function does what its twin in pixel_noise_reference.cpp does, operation by operation.
#if defined(ASTROID_VECTOR_DRAWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROID_VECTOR_DRAWS_INL
#undef ASTROID_VECTOR_DRAWS_INL
#else
#define ASTROID_VECTOR_DRAWS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "vector/pixel_noise_fits.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Singles = hn::ScalableTag<float>;
using Doubles = hn::ScalableTag<double>;
using Integers = hn::RebindToSigned<Singles>;
using Unsigned = hn::RebindToUnsigned<Singles>;
using Single = hn::Vec<Singles>;
using Double = hn::Vec<Doubles>;

/// coefficient[I] + coefficient[I + 2] x + coefficient[I + 4] x^2 + ..., unrolled whatever the compiler thinks of it.
template <std::size_t I, std::size_t N>
HWY_INLINE Single every_other(Single x, const std::array<float, N>& coefficient) {
  const Singles d;
  if constexpr (I + 2 < N) {
    return hn::Add(hn::Mul(every_other<I + 2>(x, coefficient), x), hn::Set(d, coefficient[I]));
  } else {
    return hn::Set(d, coefficient[I]);
  }
}

/// Even and odd powers apart: two short chains of dependent operations instead of one long one.
template <std::size_t N>
HWY_INLINE Single polynomial(Single x, const std::array<float, N>& coefficient) {
  const Single square = hn::Mul(x, x);
  return hn::Add(every_other<0>(square, coefficient), hn::Mul(every_other<1>(square, coefficient), x));
}

HWY_INLINE Single minus_log(Single y) {
  const Singles d;
  const Integers di;
  const auto shifted = hn::Sub(hn::BitCast(di, y), hn::Set(di, static_cast<std::int32_t>(fits::kScaledSqrtHalfBits)));
  const Single exponent = hn::ConvertTo(d, hn::ShiftRight<fits::kMantissaBits>(shifted));
  const auto mantissa = hn::And(shifted, hn::Set(di, static_cast<std::int32_t>(fits::kMantissaMask)));
  const auto bits = hn::Add(mantissa, hn::Set(di, static_cast<std::int32_t>(fits::kSqrtHalfBits)));
  const Single g = hn::Sub(hn::BitCast(d, bits), hn::Set(d, 1.0F));
  return hn::Add(hn::Mul(exponent, hn::Set(d, -fits::kLn2)),
                 hn::Sub(hn::Mul(hn::Mul(g, g), polynomial(g, fits::kMinusLog)), g));
}

HWY_INLINE Single exp_of_minus(Single x) {
  const Singles d;
  const Integers di;
  const Single rounder = hn::Set(d, 0x1.8p23F);
  const Single shifted = hn::Add(hn::Mul(x, hn::Set(d, -fits::kLog2E)), rounder);
  const Single k = hn::Sub(shifted, rounder);
  const Single r = hn::Sub(hn::Neg(x), hn::Mul(k, hn::Set(d, fits::kLn2)));
  const auto scale =
      hn::Add(hn::ShiftLeft<fits::kMantissaBits>(hn::BitCast(di, shifted)), hn::BitCast(di, hn::Set(d, 1.0F)));
  return hn::Mul(polynomial(r, fits::kExp), hn::BitCast(d, scale));
}

/// The normal quantile of words, and the share of the distribution beyond it in units of 2^-31.
struct Normals {
  Single z;
  Single tail;
};

HWY_INLINE Normals normals_of_words(hn::Vec<Unsigned> word) {
  const Singles d;
  const Integers di;
  const Unsigned du;
  const auto centred = hn::BitCast(di, hn::Xor(word, hn::Set(du, 0x80000000U)));
  const auto beyond =
      hn::Xor3(hn::Set(di, std::numeric_limits<std::int32_t>::max()), centred, hn::ShiftRight<31>(centred));
  const Single tail = hn::Add(hn::ConvertTo(d, beyond), hn::Set(d, 0.5F));
  const Single w = minus_log(hn::Mul(tail, hn::Sub(hn::Set(d, 2.0F * fits::kUnits), tail)));
  Single p = polynomial(hn::Sub(w, hn::Set(d, fits::kCentre)), fits::kCentral);
  const auto is_central = hn::Lt(w, hn::Set(d, fits::kTail));
  if (HWY_UNLIKELY(!hn::AllTrue(d, is_central))) {
    const Single far = polynomial(hn::Sub(hn::Sqrt(w), hn::Set(d, fits::kTailCentre)), fits::kFar);
    p = hn::IfThenElse(is_central, p, far);
  }
  const Single magnitude = hn::Mul(hn::Sub(hn::Set(d, fits::kUnits), tail), p);
  return {hn::CopySign(magnitude, hn::BitCast(d, centred)), tail};
}

/// Doubles of a vector of singles, in two vectors.
struct TwoDoubles {
  Double lower;
  Double upper;
};

HWY_INLINE TwoDoubles promote(Single v) {
  const Doubles d;
  const hn::Half<Singles> half;
  return {hn::PromoteTo(d, hn::LowerHalf(half, v)), hn::PromoteTo(d, hn::UpperHalf(half, v))};
}

HWY_INLINE Single demote(Double lower, Double upper) {
  const Singles d;
  const hn::Half<Singles> half;
  return hn::Combine(d, hn::DemoteTo(half, upper), hn::DemoteTo(half, lower));
}

/// Counts, and whether the word decides them.
struct Counts {
  Single steps;
  hn::Mask<Singles> decided;
};

/// @param w, tail  of normals_of_words.
HWY_INLINE Counts poisson_of_large_means(Single mean, Single fraction, Single w, Single tail) {
  const Singles d;
  const Single one = hn::Set(d, 1.0F);
  const Single root = hn::Sqrt(mean);
  const Single inverse = hn::Div(one, mean);
  const Single first = hn::Mul(root, w);
  const Single s = hn::Mul(first, inverse);
  const Single square = hn::Mul(w, w);
  const Single second = hn::Mul(square, polynomial(s, fits::kA));
  const Single third = hn::Add(polynomial(s, fits::kC0), hn::Mul(inverse, polynomial(s, fits::kC1)));
  const Single offset = hn::Add(fraction, hn::Add(first, hn::Add(second, third)));
  const Single steps = hn::Floor(offset);
  const Single distance = hn::Min(hn::Sub(offset, steps), hn::Sub(hn::Add(steps, one), offset));
  const Single bound = hn::Add(
      hn::Add(hn::Set(d, fits::kErrorFloor), hn::Mul(inverse, hn::Set(d, fits::kErrorPerMean))),
      hn::Mul(root, hn::Add(hn::Set(d, fits::kErrorOfCentre), hn::Mul(hn::Abs(w), hn::Set(d, fits::kErrorOfNormal)))));
  const auto in_range = hn::And(hn::Gt(s, hn::Set(d, fits::kLowestS)), hn::Lt(s, hn::Set(d, fits::kHighestS)));
  const auto clear = hn::Gt(hn::Mul(hn::Sub(distance, bound), tail), root);
  return {steps, hn::And(in_range, clear)};
}

HWY_INLINE Counts poisson_of_small_means(Single mean, hn::Vec<Unsigned> word) {
  const Singles d;
  const Integers di;
  const Single margin = hn::Set(d, fits::kErrorOfSum);
  const Single u = hn::Mul(hn::Add(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<1>(word))), hn::Set(d, 0.25F)),
                           hn::Set(d, 1.0F / fits::kUnits));
  Single term = exp_of_minus(mean);
  Single sum = term;
  Single n = hn::Zero(d);
  auto near = hn::Lt(n, n);
  auto active = hn::Eq(n, n);
  for (int step = 1; step <= fits::kMostSteps; ++step) {
    near = hn::Or(near, hn::And(active, hn::Le(hn::Abs(hn::Sub(u, sum)), margin)));
    active = hn::And(active, hn::Ge(u, hn::Add(sum, margin)));
    if (hn::AllFalse(d, active)) break;
    n = hn::IfThenElse(active, hn::Set(d, static_cast<float>(step)), n);
    term = hn::Mul(term, hn::Mul(mean, hn::Set(d, 1.0F / static_cast<float>(step))));
    sum = hn::Add(sum, term);
  }
  return {n, hn::Not(hn::Or(near, active))};
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
