#include "fits_counts.hpp"

#include <bit>
#include <cstddef>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

static_assert(std::endian::native == std::endian::little);

// Without branches, so that it becomes vector code. The limits are exact floats; NaN becomes the lower one.
template <class Stored, class Encode>
bool store(std::span<const float> counts, std::span<Stored> stored, float low, float high, Encode encode) {
  ASTROID_CHECK_EQ(counts.size(), stored.size());
  const float* in = counts.data();
  Stored* out = stored.data();
  std::uint32_t wrong = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const float above = in[i] > low ? in[i] : low;
    const auto whole = static_cast<std::int32_t>(above < high ? above : high);
    wrong |= static_cast<std::uint32_t>(static_cast<float>(whole) != in[i]);
    out[i] = encode(whole);
  }
  return wrong == 0;
}

}  // namespace

bool store_fits_counts(std::span<const float> counts, std::span<std::uint16_t> stored) {
  constexpr std::uint32_t kOffset = 0x8000;
  return store(counts, stored, 0.0F, 65535.0F, [](std::int32_t whole) {
    return __builtin_bswap16(static_cast<std::uint16_t>(static_cast<std::uint32_t>(whole) ^ kOffset));
  });
}

bool store_fits_counts(std::span<const float> counts, std::span<std::uint32_t> stored) {
  return store(counts, stored, -2147483648.0F, 2147483520.0F,  // the largest float below 2^31
               [](std::int32_t whole) { return __builtin_bswap32(static_cast<std::uint32_t>(whole)); });
}

}  // namespace astroid
