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

#include "vector/abreast-inl.hpp"
#include "vector/pixel_noise_fits.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// coefficient[I] + coefficient[I + 2] x + coefficient[I + 4] x^2 + ..., unrolled whatever the compiler thinks of it.
template <std::size_t I, int N, std::size_t Size>
HWY_INLINE Floats<N> every_other(Floats<N> x, const std::array<float, Size>& coefficient) {
  if constexpr (I + 2 >= Size) {
    return all_of<Floats<N>>(coefficient[I]);
  } else if constexpr (I + 4 >= Size) {
    return x * coefficient[I + 2] + coefficient[I];
  } else {
    return every_other<I + 2>(x, coefficient) * x + coefficient[I];
  }
}

/// Even and odd powers apart: two short chains of dependent operations instead of one long one.
template <int N, std::size_t Size>
HWY_INLINE Floats<N> polynomial(Floats<N> x, const std::array<float, Size>& coefficient) {
  const Floats<N> square = x * x;
  return every_other<0>(square, coefficient) + every_other<1>(square, coefficient) * x;
}

/// -ln(y / 2^62).
template <int N>
HWY_INLINE Floats<N> minus_log(Floats<N> y) {
  const Ints<N> shifted = as_ints(y) - static_cast<std::int32_t>(fits::kScaledSqrtHalfBits);
  const Floats<N> exponent = to_floats(shift_right<fits::kMantissaBits>(shifted));
  const Ints<N> mantissa = shifted & static_cast<std::int32_t>(fits::kMantissaMask);
  const Floats<N> g = as_floats(mantissa + static_cast<std::int32_t>(fits::kSqrtHalfBits)) - 1.0F;
  return exponent * -fits::kLn2 + (g * g * polynomial(g, fits::kMinusLog) - g);
}

template <int N>
HWY_INLINE Floats<N> exp_of_minus(Floats<N> x) {
  constexpr float kRounder = 0x1.8p23F;  // added, it leaves the nearest integer in the lowest bits
  constexpr std::int32_t kOneBits = 0x3f800000;
  const Floats<N> shifted = x * -fits::kLog2E + kRounder;
  const Floats<N> k = shifted - kRounder;
  const Floats<N> r = -x - k * fits::kLn2;
  return polynomial(r, fits::kExp) * as_floats(shift_left<fits::kMantissaBits>(as_ints(shifted)) + kOneBits);
}

/// The normal quantile of words, and the share of the distribution beyond it in units of 2^-31.
template <int N>
struct Normals {
  Floats<N> z;
  Floats<N> tail;
};

/// p, and beyond kTail the fit that holds there. A vector in twenty has such a lane: one in four is not worked out for
/// the sake of its neighbours.
HWY_INLINE hn::Vec<Singles> central_or_far(hn::Vec<Singles> p, hn::Vec<Singles> w) {
  const Floats<1> at{w};
  const Masks<1> is_central = at < fits::kTail;
  if (everywhere(is_central)) return p;
  return choose(is_central, {p}, polynomial(square_root(at) - fits::kTailCentre, fits::kFar)).first;
}

template <int N>
HWY_INLINE Normals<N> normals_of_words(Words<N> word) {
  const Words<N> flipped = ~word;
  const Floats<N> tail = to_floats(as_ints(smaller(word, flipped))) + 0.5F;
  const Floats<N> w = minus_log(tail * (2.0F * fits::kUnits - tail));
  Floats<N> p = polynomial(w - fits::kCentre, fits::kCentral);
  if (HWY_UNLIKELY(!everywhere(w < fits::kTail))) p = each(central_or_far, p, w);
  return {with_sign((fits::kUnits - tail) * p, flipped), tail};
}

/// Counts, and whether the word decides them.
template <int N>
struct Counts {
  Floats<N> steps;
  Masks<N> decided;
};

/// Steps from floor(mean) on.
template <int N>
HWY_INLINE Counts<N> poisson_of_large_means(Floats<N> mean, Floats<N> fraction, Normals<N> normals) {
  const auto& [w, tail] = normals;
  const Floats<N> root = square_root(mean);
  const Floats<N> inverse = reciprocal(mean);
  const Floats<N> first = root * w;
  const Floats<N> s = first * inverse;
  const Floats<N> second = w * w * polynomial(s, fits::kA);
  const Floats<N> third = polynomial(s, fits::kC0) + inverse * polynomial(s, fits::kC1);
  const Floats<N> offset = fraction + (first + (second + third));
  const Floats<N> steps = nearest(offset);
  const Floats<N> room =
      fits::kRoom - inverse * fits::kErrorPerMean - root * (magnitude(w) * fits::kErrorOfNormal + fits::kErrorOfCentre);
  const Masks<N> in_range = (s > fits::kLowestS) & (s < fits::kHighestS);
  return {steps, in_range & ((room - magnitude(offset - steps)) * tail > root)};
}

/// Counts from 0 on.
template <int N>
HWY_INLINE Counts<N> poisson_of_small_means(Floats<N> mean, Words<N> word) {
  const Floats<N> u = (to_floats(as_ints(shift_right<1>(word))) + 0.25F) * (1.0F / fits::kUnits);
  Floats<N> term = exp_of_minus(mean);
  Floats<N> sum = term;
  Floats<N> n = all_of<Floats<N>>(0.0F);
  Masks<N> near = n < n;
  Masks<N> active = !near;
  for (int step = 1; step <= fits::kMostSteps; ++step) {
    near = near | (active & (magnitude(u - sum) <= fits::kErrorOfSum));
    active = active & (u >= sum + fits::kErrorOfSum);
    if (nowhere(active)) break;
    n = choose(active, all_of<Floats<N>>(static_cast<float>(step)), n);
    term = term * (mean * (1.0F / static_cast<float>(step)));
    sum = sum + term;
  }
  return {n, !(near | active)};
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
