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
  }
  std::array<std::uint64_t, kPhiloxRounds> first;
  std::array<std::uint64_t, kPhiloxRounds> second;
};

using Words64 = hn::ScalableTag<std::uint64_t>;
using Words32 = hn::Repartition<std::uint32_t, Words64>;
using Vector64 = hn::Vec<Words64>;

/// Counters that one call of philox() takes, one in each 64-bit lane, whose low half holds a part of the counter.
HWY_INLINE constexpr std::size_t philox_counters() {
  return HWY_LANES(std::uint64_t);
}

/// Counters in their order to the lanes that philox() wants them in: the first half of them in the even lanes, the
/// second half in the odd ones. Then their words come out in order.
HWY_INLINE Vector64 in_philox_order(Vector64 counters) {
  const Words64 d;
  alignas(64) std::array<std::uint64_t, philox_counters()> order;
  for (std::size_t lane = 0; lane < order.size(); ++lane) order[lane] = lane / 2 + lane % 2 * (order.size() / 2);
  return hn::TableLookupLanes(counters, hn::SetTableIndices(d, order.data()));
}

/// Writes the words of the counters, four each, to 4 * philox_counters() places.
/// @param c0 … c3  the words of the counters, in_philox_order().
HWY_INLINE void philox(const PhiloxKeys& keys, Vector64 c0, Vector64 c1, Vector64 c2, Vector64 c3,
                       std::uint32_t* HWY_RESTRICT out) {
  const Words64 d;
  const Words32 d32;
  const auto multiplier0 = hn::BitCast(d32, hn::Set(d, std::uint64_t{PHILOX_M4x32_0}));
  const auto multiplier1 = hn::BitCast(d32, hn::Set(d, std::uint64_t{PHILOX_M4x32_1}));
  // A multiplication reads the low halves of lanes only, so the high ones may hold anything in between.
#pragma GCC unroll 10
  for (unsigned round = 0; round < kPhiloxRounds; ++round) {
    const Vector64 product0 = hn::MulEven(hn::BitCast(d32, c0), multiplier0);
    const Vector64 product1 = hn::MulEven(hn::BitCast(d32, c2), multiplier1);
    c0 = hn::Xor3(hn::ShiftRight<32>(product1), c1, hn::Set(d, keys.first[round]));
    c1 = product1;
    c2 = hn::Xor3(hn::ShiftRight<32>(product0), c3, hn::Set(d, keys.second[round]));
    c3 = product0;
  }
  const Vector64 words01 = hn::BitCast(d, hn::OddEven(hn::BitCast(d32, hn::ShiftLeft<32>(c1)), hn::BitCast(d32, c0)));
  const Vector64 words23 = hn::BitCast(d, hn::OddEven(hn::BitCast(d32, hn::ShiftLeft<32>(c3)), hn::BitCast(d32, c2)));
  hn::StoreU(hn::BitCast(d32, hn::InterleaveLower(d, words01, words23)), d32, out);
  hn::StoreU(hn::BitCast(d32, hn::InterleaveUpper(d, words01, words23)), d32, out + hn::Lanes(d32));
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
