// Several vectors side by side, as one value with operators. Included once for every instruction set (Highway's
// scheme).
//
// A draw is one long chain of dependent operations, each of which takes the processor three or four cycles. Abreast are
// independent chains: while one waits, the next is worked on.
#if defined(ASTROID_VECTOR_ABREAST_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROID_VECTOR_ABREAST_INL
#undef ASTROID_VECTOR_ABREAST_INL
#else
#define ASTROID_VECTOR_ABREAST_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Singles = hn::ScalableTag<float>;
using Doubles = hn::ScalableTag<double>;
using Integers = hn::RebindToSigned<Singles>;
using Unsigned = hn::RebindToUnsigned<Singles>;

/// N vectors, or masks. A list, not an array: only values of their own are sure to live in registers.
template <class V, int N>
struct Abreast {
  V first;
  Abreast<V, N - 1> rest;
};
template <class V>
struct Abreast<V, 1> {
  V first;
};

template <int N>
using Floats = Abreast<hn::Vec<Singles>, N>;
template <int N>
using Words = Abreast<hn::Vec<Unsigned>, N>;
template <int N>
using Ints = Abreast<hn::Vec<Integers>, N>;
template <int N>
using Masks = Abreast<hn::Mask<Singles>, N>;

/// function(x, others…) of each of the vectors.
template <class Function, class V, int N, class... Others>
HWY_INLINE auto each(Function function, Abreast<V, N> x, Abreast<Others, N>... others) {
  using Result = decltype(function(x.first, others.first...));
  if constexpr (N == 1) {
    return Abreast<Result, 1>{function(x.first, others.first...)};
  } else {
    return Abreast<Result, N>{function(x.first, others.first...), each(function, x.rest, others.rest...)};
  }
}

template <class V>
using ValueOf = hn::TFromV<V>;

template <class V>
HWY_INLINE V set(ValueOf<V> value) {
  return hn::Set(hn::DFromV<V>(), value);
}

/// The same value everywhere, of Floats<N> for one.
template <class A>
HWY_INLINE A all_of(ValueOf<decltype(A::first)> value) {
  if constexpr (sizeof(A) == sizeof(A::first)) {
    return {set<decltype(A::first)>(value)};
  } else {
    return {set<decltype(A::first)>(value), all_of<decltype(A::rest)>(value)};
  }
}

template <class V, int N>
HWY_INLINE Abreast<V, N> operator+(Abreast<V, N> x, Abreast<V, N> y) {
  return each([](V a, V b) { return hn::Add(a, b); }, x, y);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator-(Abreast<V, N> x, Abreast<V, N> y) {
  return each([](V a, V b) { return hn::Sub(a, b); }, x, y);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator*(Abreast<V, N> x, Abreast<V, N> y) {
  return each([](V a, V b) { return hn::Mul(a, b); }, x, y);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator+(Abreast<V, N> x, ValueOf<V> value) {
  return each([v = set<V>(value)](V a) { return hn::Add(a, v); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator-(Abreast<V, N> x, ValueOf<V> value) {
  return each([v = set<V>(value)](V a) { return hn::Sub(a, v); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator-(ValueOf<V> value, Abreast<V, N> x) {
  return each([v = set<V>(value)](V a) { return hn::Sub(v, a); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator*(Abreast<V, N> x, ValueOf<V> value) {
  return each([v = set<V>(value)](V a) { return hn::Mul(a, v); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator&(Abreast<V, N> x, ValueOf<V> value) {
  return each([v = set<V>(value)](V a) { return hn::And(a, v); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator~(Abreast<V, N> x) {
  return each([](V a) { return hn::Not(a); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> operator-(Abreast<V, N> x) {
  return each([](V a) { return hn::Neg(a); }, x);
}
template <class V, int N>
HWY_INLINE Abreast<V, N> smaller(Abreast<V, N> x, Abreast<V, N> y) {
  return each([](V a, V b) { return hn::Min(a, b); }, x, y);
}
template <int kBits, class V, int N>
HWY_INLINE Abreast<V, N> shift_right(Abreast<V, N> x) {
  return each([](V a) { return hn::ShiftRight<kBits>(a); }, x);
}
template <int kBits, class V, int N>
HWY_INLINE Abreast<V, N> shift_left(Abreast<V, N> x) {
  return each([](V a) { return hn::ShiftLeft<kBits>(a); }, x);
}

template <int N>
HWY_INLINE Floats<N> square_root(Floats<N> x) {
  return each([](auto a) { return hn::Sqrt(a); }, x);
}
template <int N>
HWY_INLINE Floats<N> reciprocal(Floats<N> x) {
  return each([one = hn::Set(Singles(), 1.0F)](auto a) { return hn::Div(one, a); }, x);
}
template <int N>
HWY_INLINE Floats<N> magnitude(Floats<N> x) {
  return each([](auto a) { return hn::Abs(a); }, x);
}
template <int N>
HWY_INLINE Floats<N> nearest(Floats<N> x) {
  return each([](auto a) { return hn::Round(a); }, x);
}

/// The magnitudes of x, the highest bits of y.
template <int N>
HWY_INLINE Floats<N> with_sign(Floats<N> x, Words<N> y) {
  return each([](auto a, auto b) { return hn::CopySign(a, hn::BitCast(Singles(), b)); }, x, y);
}

/// Integers to floats of the same values.
template <int N>
HWY_INLINE Floats<N> to_floats(Ints<N> x) {
  return each([](auto a) { return hn::ConvertTo(Singles(), a); }, x);
}
/// The same bits, read otherwise.
template <int N>
HWY_INLINE Floats<N> as_floats(Ints<N> x) {
  return each([](auto a) { return hn::BitCast(Singles(), a); }, x);
}
template <class V, int N>
HWY_INLINE Ints<N> as_ints(Abreast<V, N> x) {
  return each([](V a) { return hn::BitCast(Integers(), a); }, x);
}

template <int N>
HWY_INLINE Masks<N> operator<(Floats<N> x, Floats<N> y) {
  return each([](auto a, auto b) { return hn::Lt(a, b); }, x, y);
}
template <int N>
HWY_INLINE Masks<N> operator<(Floats<N> x, float value) {
  return each([v = hn::Set(Singles(), value)](auto a) { return hn::Lt(a, v); }, x);
}
template <int N>
HWY_INLINE Masks<N> operator<=(Floats<N> x, float value) {
  return each([v = hn::Set(Singles(), value)](auto a) { return hn::Le(a, v); }, x);
}
template <int N>
HWY_INLINE Masks<N> operator>=(Floats<N> x, Floats<N> y) {
  return each([](auto a, auto b) { return hn::Ge(a, b); }, x, y);
}
template <int N>
HWY_INLINE Masks<N> operator>(Floats<N> x, Floats<N> y) {
  return each([](auto a, auto b) { return hn::Gt(a, b); }, x, y);
}
template <int N>
HWY_INLINE Masks<N> operator>(Floats<N> x, float value) {
  return each([v = hn::Set(Singles(), value)](auto a) { return hn::Gt(a, v); }, x);
}
template <int N>
HWY_INLINE Masks<N> operator>=(Floats<N> x, float value) {
  return each([v = hn::Set(Singles(), value)](auto a) { return hn::Ge(a, v); }, x);
}
template <int N>
HWY_INLINE Masks<N> operator&(Masks<N> x, Masks<N> y) {
  return each([](auto a, auto b) { return hn::And(a, b); }, x, y);
}
template <int N>
HWY_INLINE Masks<N> operator|(Masks<N> x, Masks<N> y) {
  return each([](auto a, auto b) { return hn::Or(a, b); }, x, y);
}
template <int N>
HWY_INLINE Masks<N> operator!(Masks<N> x) {
  return each([](auto a) { return hn::Not(a); }, x);
}
template <int N>
HWY_INLINE Floats<N> choose(Masks<N> mask, Floats<N> yes, Floats<N> no) {
  return each([](auto m, auto a, auto b) { return hn::IfThenElse(m, a, b); }, mask, yes, no);
}
template <int N>
HWY_INLINE hn::Mask<Singles> in_all(Masks<N> mask) {
  if constexpr (N == 1) {
    return mask.first;
  } else {
    return hn::And(mask.first, in_all(mask.rest));
  }
}
/// Whether masks hold everywhere, or nowhere.
template <int N>
HWY_INLINE bool everywhere(Masks<N> mask) {
  return hn::AllTrue(Singles(), in_all(mask));
}
template <int N>
HWY_INLINE bool nowhere(Masks<N> mask) {
  return everywhere(!mask);
}

/// Vectors one after the other in memory.
template <int N>
HWY_INLINE Floats<N> load_floats(const float* from) {
  const Singles d;
  if constexpr (N == 1) {
    return {hn::LoadU(d, from)};
  } else {
    return {hn::LoadU(d, from), load_floats<N - 1>(from + hn::Lanes(d))};
  }
}
template <int N>
HWY_INLINE Words<N> load_words(const std::uint32_t* from) {
  const Unsigned d;
  if constexpr (N == 1) {
    return {hn::LoadU(d, from)};
  } else {
    return {hn::LoadU(d, from), load_words<N - 1>(from + hn::Lanes(d))};
  }
}
template <int N>
HWY_INLINE void store(Floats<N> x, float* to) {
  const Singles d;
  hn::StoreU(x.first, d, to);
  if constexpr (N > 1) store(x.rest, to + hn::Lanes(d));
}

/// As many doubles as a vector has floats.
struct Pair {
  hn::Vec<Doubles> lower;
  hn::Vec<Doubles> upper;
};
template <int N>
using Pairs = Abreast<Pair, N>;

HWY_INLINE Pair to_doubles(hn::Vec<Singles> x) {
  const Doubles d;
  const hn::Half<Singles> half;
  return {hn::PromoteTo(d, hn::LowerHalf(half, x)), hn::PromoteTo(d, hn::UpperHalf(half, x))};
}
HWY_INLINE hn::Vec<Singles> to_singles(Pair x) {
  const hn::Half<Singles> half;
  return hn::Combine(Singles(), hn::DemoteTo(half, x.upper), hn::DemoteTo(half, x.lower));
}
template <int N>
HWY_INLINE Pairs<N> to_doubles(Floats<N> x) {
  return each([](hn::Vec<Singles> a) { return to_doubles(a); }, x);
}
template <int N>
HWY_INLINE Floats<N> to_singles(Pairs<N> x) {
  return each([](Pair a) { return to_singles(a); }, x);
}
template <int N>
HWY_INLINE Pairs<N> operator+(Pairs<N> x, Pairs<N> y) {
  return each([](Pair a, Pair b) { return Pair{hn::Add(a.lower, b.lower), hn::Add(a.upper, b.upper)}; }, x, y);
}
template <int N>
HWY_INLINE Pairs<N> operator-(Pairs<N> x, Pairs<N> y) {
  return each([](Pair a, Pair b) { return Pair{hn::Sub(a.lower, b.lower), hn::Sub(a.upper, b.upper)}; }, x, y);
}
template <int N>
HWY_INLINE Pairs<N> nearest(Pairs<N> x) {
  return each([](Pair a) { return Pair{hn::Round(a.lower), hn::Round(a.upper)}; }, x);
}
template <int N>
HWY_INLINE Pairs<N> whole_part(Pairs<N> x) {
  return each([](Pair a) { return Pair{hn::Floor(a.lower), hn::Floor(a.upper)}; }, x);
}
template <int N>
HWY_INLINE Pairs<N> load_doubles(const double* from) {
  const Doubles d;
  const Pair first{hn::LoadU(d, from), hn::LoadU(d, from + hn::Lanes(d))};
  if constexpr (N == 1) {
    return {first};
  } else {
    return {first, load_doubles<N - 1>(from + 2 * hn::Lanes(d))};
  }
}
template <int N>
HWY_INLINE void store(Pairs<N> x, double* to) {
  const Doubles d;
  hn::StoreU(x.first.lower, d, to);
  hn::StoreU(x.first.upper, d, to + hn::Lanes(d));
  if constexpr (N > 1) store(x.rest, to + 2 * hn::Lanes(d));
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
