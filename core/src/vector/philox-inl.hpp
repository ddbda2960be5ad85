// Philox4x32-10 on vectors of counters. Included once for every instruction set (Highway's scheme).
#if defined(ASTROID_VECTOR_PHILOX_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROID_VECTOR_PHILOX_INL
#undef ASTROID_VECTOR_PHILOX_INL
#else
#define ASTROID_VECTOR_PHILOX_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "philox.hpp"
#include "vector/abreast-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The keys of all rounds.
struct PhiloxKeys {
  explicit PhiloxKeys(const RandomStream& stream) {
    std::uint32_t key0 = stream.key[0];
    std::uint32_t key1 = stream.key[1];
    for (unsigned round = 0; round < kPhiloxRounds; ++round) {
      first[round] = key0;
      second[round] = key1;
      key0 += PHILOX_W32_0;
      key1 += PHILOX_W32_1;
    }
    // The last round makes its words in the high halves.
    first.back() <<= 32U;
    second.back() <<= 32U;
  }
  std::array<std::uint64_t, kPhiloxRounds> first;
  std::array<std::uint64_t, kPhiloxRounds> second;
};

using Words64 = hn::ScalableTag<std::uint64_t>;
using Words32 = hn::Repartition<std::uint32_t, Words64>;
using Vector64 = hn::Vec<Words64>;

/// How many vectors of counters philox() takes.
constexpr int kPhiloxAbreast = 2;
using Counters = Abreast<Vector64, kPhiloxAbreast>;

/// Counters that one call of philox() takes, one in each 64-bit lane, whose low half holds a part of the counter.
HWY_INLINE constexpr std::size_t philox_counters() {
  return kPhiloxAbreast * HWY_LANES(std::uint64_t);
}

/// Counters in their order to the lanes that philox() wants them in: the first half of a vector in the even lanes, the
/// second half in the odd ones. Then their words come out in order.
HWY_INLINE Vector64 in_philox_order(Vector64 counters) {
  const Words64 d;
  alignas(64) std::array<std::uint64_t, HWY_LANES(std::uint64_t)> order;
  for (std::size_t lane = 0; lane < order.size(); ++lane) order[lane] = lane / 2 + lane % 2 * (order.size() / 2);
  return hn::TableLookupLanes(counters, hn::SetTableIndices(d, order.data()));
}

HWY_INLINE Counters multiply(Counters low_halves, std::uint64_t by) {
  const Words32 d;
  return each([=, m = hn::BitCast(d, hn::Set(Words64(), by))](Vector64 c) { return hn::MulEven(hn::BitCast(d, c), m); },
              low_halves);
}
HWY_INLINE Counters exclusive_or(Counters x, Counters y, std::uint64_t key) {
  return each([k = hn::Set(Words64(), key)](Vector64 a, Vector64 b) { return hn::Xor3(a, b, k); }, x, y);
}

/// Writes the words of the counters, four each, to 4 * philox_counters() places.
/// @param c0 … c3  the words of the counters, in_philox_order().
HWY_INLINE void philox(const PhiloxKeys& keys, Counters c0, Counters c1, Counters c2, Counters c3,
                       std::uint32_t* HWY_RESTRICT out) {
  // A multiplication reads the low halves of lanes only, so the high ones may hold anything in between.
#pragma GCC unroll 10
  for (unsigned round = 0; round + 1 < kPhiloxRounds; ++round) {
    const Counters product0 = multiply(c0, PHILOX_M4x32_0);
    const Counters product1 = multiply(c2, PHILOX_M4x32_1);
    c0 = exclusive_or(shift_right<32>(product1), c1, keys.first[round]);
    c1 = product1;
    c2 = exclusive_or(shift_right<32>(product0), c3, keys.second[round]);
    c3 = product0;
  }
  // The last round leaves the first word of a product's pair in the high half, where it is made, and the second in the
  // low one.
  const Counters words10 = exclusive_or(multiply(c2, PHILOX_M4x32_1), shift_left<32>(c1), keys.first.back());
  const Counters words32 = exclusive_or(multiply(c0, PHILOX_M4x32_0), shift_left<32>(c3), keys.second.back());
  each(
      [&out](Vector64 w10, Vector64 w32) {
        const Words64 d;
        const Words32 d32;
        hn::StoreU(hn::Shuffle2301(hn::BitCast(d32, hn::InterleaveLower(d, w10, w32))), d32, out);
        hn::StoreU(hn::Shuffle2301(hn::BitCast(d32, hn::InterleaveUpper(d, w10, w32))), d32, out + hn::Lanes(d32));
        out += 2 * hn::Lanes(d32);
        return 0;
      },
      words10, words32);
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
