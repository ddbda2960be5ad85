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

/// Goes through pixels block by block: `while (blocks.next())` with words() of pixels first() to first() + size(). Wide
/// rows are cut into blocks; narrow ones, as of windows, share one, so that no vector runs empty.
class WordBlocks {
 public:
  static constexpr std::size_t kBlock = 256;                // pixels; some kilobytes on the stack
  static constexpr std::size_t kWidestVector = 16;          // singles
  static constexpr std::size_t kSlack = 4 * kWidestVector;  // so that loops may take four vectors at a time

  WordBlocks(const RandomStream& stream, const PixelPlaces& pixels)
      : keys_(stream), pixels_(pixels), low_counter_(pixel_counter(address_of(pixels, 0, 0), 0)) {}

  HWY_INLINE bool next() {
    first_ += size_;
    size_ = 0;
    while (area_ < pixels_.areas.size() && pixels_.areas[area_].empty()) ++area_;
    if (area_ == pixels_.areas.size()) return false;
    if (pixels_.areas[area_].nx > kNarrow) {
      part_of_row();
    } else {
      whole_rows();
    }
    return true;
  }
  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Readable, without meaning, up to kSlack words beyond size().
  [[nodiscard]] const std::uint32_t* words() const { return words_; }

 private:
  static constexpr int kNarrow = 96;  // pixels in a row
  static constexpr std::size_t kCounters = kBlock / kWordsOfCounter + kWidestVector;

  static std::size_t lead_of(int x) { return static_cast<std::uint32_t>(x) % kWordsOfCounter; }
  static std::size_t counters_of(int x, std::size_t columns) {
    return (lead_of(x) + columns + kWordsOfCounter - 1) / kWordsOfCounter;
  }

  HWY_INLINE void part_of_row() {
    const Rectangle& area = pixels_.areas[area_];
    const auto columns = static_cast<std::size_t>(area.nx) - column_;
    size_ = std::min(kBlock, columns);
    const int x = area.x0 + static_cast<int>(column_);
    const RandomWords counter = pixel_counter(address_of(pixels_, x, area.y0 + row_), x);
    const Words64 d;
    Counters c0{in_philox_order(hn::Iota(d, counter[0])),
                {in_philox_order(hn::Iota(d, counter[0] + HWY_LANES(std::uint64_t)))}};
    const Counters c1 = all_of<Counters>(counter[1]);
    const Counters c2 = all_of<Counters>(counter[2]);
    const Counters c3 = all_of<Counters>(counter[3]);
    const std::size_t counters = counters_of(x, size_);
    for (std::size_t i = 0; i < counters; i += philox_counters()) {
      philox(keys_, c0, c1, c2, c3, buffer_.data() + kWordsOfCounter * i);
      c0 = c0 + std::uint64_t{philox_counters()};
    }
    words_ = buffer_.data() + lead_of(x);
    column_ += size_;
    if (column_ < static_cast<std::size_t>(area.nx)) return;
    column_ = 0;
    next_row();
  }

  HWY_INLINE void next_row() {
    if (++row_ < pixels_.areas[area_].ny) return;
    row_ = 0;
    ++area_;
  }

  /// As many narrow rows as fit, of one area or several: their counters side by side, then the words of each picked
  /// out.
  HWY_INLINE void whole_rows() {
    constexpr std::size_t kAtOnce = philox_counters();
    constexpr std::size_t kMostRows = kBlock;
    alignas(64) std::array<std::uint64_t, kCounters> columns;
    alignas(64) std::array<std::uint64_t, kCounters> lines;
    std::array<std::uint16_t, kMostRows> begin;  // of each row's words
    std::array<std::uint16_t, kMostRows> length;
    std::size_t counters = 0;
    std::size_t rows = 0;
    while (area_ < pixels_.areas.size()) {
      const Rectangle& area = pixels_.areas[area_];
      if (area.empty()) {
        ++area_;
        continue;
      }
      const auto width = static_cast<std::size_t>(area.nx);
      const std::size_t needed = counters_of(area.x0, width);
      if (area.nx > kNarrow || counters + needed > kBlock / kWordsOfCounter || rows == kMostRows) break;
      const RandomWords counter = pixel_counter(address_of(pixels_, area.x0, area.y0 + row_), area.x0);
      begin[rows] = static_cast<std::uint16_t>(counters * kWordsOfCounter + lead_of(area.x0));
      length[rows++] = static_cast<std::uint16_t>(width);
      for (std::size_t k = 0; k < needed; ++k, ++counters) {
        columns[counters] = counter[0] + k;  // its low half counts
        lines[counters] = counter[1];
      }
      size_ += width;
      next_row();
    }
    for (std::size_t i = counters; i % kAtOnce != 0; ++i) columns[i] = lines[i] = 0;
    const Counters c2 = all_of<Counters>(low_counter_[2]);
    const Counters c3 = all_of<Counters>(low_counter_[3]);
    const auto load = [](const std::uint64_t* from) {
      const Words64 d;
      return Counters{in_philox_order(hn::Load(d, from)), {in_philox_order(hn::Load(d, from + hn::Lanes(d)))}};
    };
    for (std::size_t i = 0; i < counters; i += kAtOnce)
      philox(keys_, load(columns.data() + i), load(lines.data() + i), c2, c3, buffer_.data() + kWordsOfCounter * i);
    std::uint32_t* packed = packed_.data();
    for (std::size_t r = 0; r < rows; ++r) {
      // A fixed length is copied in two instructions; what is too much of it is overwritten by the next row.
      if (length[r] <= kWidestVector) {
        std::copy_n(buffer_.data() + begin[r], kWidestVector, packed);
      } else {
        std::copy_n(buffer_.data() + begin[r], length[r], packed);
      }
      packed += length[r];
    }
    words_ = packed_.data();
  }

  PhiloxKeys keys_;
  PixelPlaces pixels_;
  RandomWords low_counter_;  // exposure, read and draw in its last two words
  std::size_t area_ = 0;
  int row_ = 0;
  std::size_t column_ = 0;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  const std::uint32_t* words_ = nullptr;
  alignas(64) std::array<std::uint32_t, kCounters * kWordsOfCounter + kSlack> buffer_;
  alignas(64) std::array<std::uint32_t, kBlock + kSlack> packed_;
};

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
