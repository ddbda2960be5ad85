// The random words of rows of pixels in blocks of some hundred. Included once for every instruction set (Highway's
// scheme).
#if defined(ASTROID_VECTOR_WORD_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROID_VECTOR_WORD_BLOCKS_INL
#undef ASTROID_VECTOR_WORD_BLOCKS_INL
#else
#define ASTROID_VECTOR_WORD_BLOCKS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "vector/philox-inl.hpp"
#include "vector/pixel_counter.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Goes through rows of pixels block by block: `while (blocks.next())` with words() of pixels first() to first() +
/// size(). A wide row is cut into blocks; narrow rows, as of windows, share one, so that no vector runs empty.
class WordBlocks {
 public:
  static constexpr std::size_t kBlock = 256;        // pixels; some kilobytes on the stack
  static constexpr std::size_t kWidestVector = 16;  // singles

  WordBlocks(const RandomStream& stream, const PixelRows& pixels, std::size_t columns)
      : keys_(stream), pixels_(pixels), columns_(columns) {}

  HWY_INLINE bool next() {
    first_ += size_;
    if (first_ >= columns_ * pixels_.rows) return false;
    if (columns_ > kNarrow) {
      wide();
    } else {
      narrow();
    }
    return true;
  }
  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Readable, without meaning, up to a whole vector beyond size().
  [[nodiscard]] const std::uint32_t* words() const { return words_; }

 private:
  static constexpr std::size_t kNarrow = 96;  // pixels in a row
  static constexpr std::size_t kCounters = kBlock / kWordsOfCounter + kWidestVector;

  HWY_INLINE void wide() {
    const std::size_t column = first_ % columns_;
    size_ = std::min(kBlock, columns_ - column);
    PixelAddress address = pixels_.address;
    address.y += static_cast<std::int32_t>(first_ / columns_);
    const std::int32_t x = address.x0 + static_cast<std::int32_t>(column);
    const std::size_t lead = static_cast<std::uint32_t>(x) % kWordsOfCounter;
    const std::size_t counters = (lead + size_ + kWordsOfCounter - 1) / kWordsOfCounter;
    const RandomWords counter = pixel_counter(address, x);
    alignas(64) std::array<std::uint64_t, philox_counters()> lanes;
    for (std::size_t i = 0; i < lanes.size(); ++i) lanes[philox_lane(i)] = counter[0] + i;
    const Words64 d;
    Vector64 c0 = hn::LoadU(d, lanes.data());
    const Vector64 c1 = hn::Set(d, std::uint64_t{counter[1]});
    const Vector64 c2 = hn::Set(d, std::uint64_t{counter[2]});
    const Vector64 c3 = hn::Set(d, std::uint64_t{counter[3]});
    const Vector64 step = hn::Set(d, std::uint64_t{philox_counters()});
    for (std::size_t i = 0; i < counters; i += philox_counters()) {
      philox(keys_, c0, c1, c2, c3, buffer_.data() + kWordsOfCounter * i);
      c0 = hn::Add(c0, step);
    }
    words_ = buffer_.data() + lead;
  }

  /// As many whole rows as fit: their counters side by side, then the words of each row picked out.
  HWY_INLINE void narrow() {
    const std::int32_t x = pixels_.address.x0;
    const std::size_t lead = static_cast<std::uint32_t>(x) % kWordsOfCounter;
    const std::size_t per_row = (lead + columns_ + kWordsOfCounter - 1) / kWordsOfCounter;
    const std::size_t row = first_ / columns_;
    const std::size_t rows = std::min(pixels_.rows - row, kBlock / (per_row * kWordsOfCounter));
    size_ = rows * columns_;
    const RandomWords counter = pixel_counter(pixels_.address, x);
    constexpr std::size_t kAtOnce = philox_counters();
    alignas(64) std::array<std::uint64_t, kCounters> columns;
    alignas(64) std::array<std::uint64_t, kCounters> lines;
    std::size_t count = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      const std::uint32_t y = counter[1] + static_cast<std::uint32_t>(row + r);
      for (std::size_t k = 0; k < per_row; ++k, ++count) {
        const std::size_t place = count / kAtOnce * kAtOnce + philox_lane(count % kAtOnce);
        columns[place] = static_cast<std::uint32_t>(counter[0] + static_cast<std::uint32_t>(k));
        lines[place] = y;
      }
    }
    for (; count % kAtOnce != 0; ++count) {
      const std::size_t place = count / kAtOnce * kAtOnce + philox_lane(count % kAtOnce);
      columns[place] = 0;
      lines[place] = 0;
    }
    const Words64 d;
    const Vector64 c2 = hn::Set(d, std::uint64_t{counter[2]});
    const Vector64 c3 = hn::Set(d, std::uint64_t{counter[3]});
    for (std::size_t i = 0; i < count; i += kAtOnce)
      philox(keys_, hn::LoadU(d, columns.data() + i), hn::LoadU(d, lines.data() + i), c2, c3,
             buffer_.data() + kWordsOfCounter * i);
    for (std::size_t r = 0; r < rows; ++r)
      std::copy_n(buffer_.data() + r * per_row * kWordsOfCounter + lead, columns_, packed_.data() + r * columns_);
    words_ = packed_.data();
  }

  PhiloxKeys keys_;
  PixelRows pixels_;
  std::size_t columns_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  const std::uint32_t* words_ = nullptr;
  alignas(64) std::array<std::uint32_t, kCounters * kWordsOfCounter> buffer_;
  alignas(64) std::array<std::uint32_t, kBlock + kWidestVector> packed_;
};

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
