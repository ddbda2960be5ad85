// Rows of pixels in blocks: straight loops that the compiler turns into vector code, then the few pixels that need
// more. The values are those of the scalar functions, to the bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"
#include "inline_exponential.hpp"
#include "normal_quantile.hpp"
#include "philox.hpp"
#include "poisson_quantile.hpp"

// Processors with wider vectors than the x86-64-v2 baseline run their own copy of a loop, chosen when the program is
// loaded. No copy uses FMA (-ffp-contract=off) or reorders a sum, so all give the same bits. Sanitizers are not ready
// yet when that choice is made, and clang does not know these names of processors.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__) || !defined(__OPTIMIZE__)
#define ASTROID_WIDE_VECTORS
#else
#define ASTROID_WIDE_VECTORS [[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]]
#endif

namespace astroid {

namespace {

constexpr unsigned kHalfWordBits = 16;
constexpr unsigned kWordBits = 32;
constexpr unsigned kLaneBits = 2;  // Philox gives four words per counter: four neighbouring columns
constexpr std::size_t kLanes = 1U << kLaneBits;
constexpr std::size_t kBlock = 256;       // pixels; some kilobytes on the stack
constexpr std::size_t kWidestVector = 8;  // doubles

using DoubleBlock = std::array<double, kBlock>;
using IndexBlock = std::array<std::uint32_t, kBlock>;

/// The counter of the four pixels that column x belongs to.
RandomWords pixel_counter(const PixelAddress& address, std::int32_t x) {
  return {static_cast<std::uint32_t>(x >> kLaneBits), static_cast<std::uint32_t>(address.y), address.exposure,
          std::uint32_t{address.read} << kHalfWordBits | address.draw};
}

/// The words of `size` <= kBlock pixels from column x on: those of philox_words, round by round for all counters at
/// once, which becomes vector code where one counter after the other does not.
class WordBlock {
 public:
  [[gnu::always_inline]] WordBlock(const RandomStream& stream, const PixelAddress& address, std::int32_t x,
                                   std::size_t size)
      : first_(static_cast<std::uint32_t>(x) % kLanes) {
    constexpr std::uint64_t kMultiplier0 = PHILOX_M4x32_0;
    constexpr std::uint64_t kMultiplier1 = PHILOX_M4x32_1;
    constexpr std::size_t kCounters = kBlock / kLanes + 1;
    const std::size_t counters = (first_ + size + kLanes - 1) / kLanes;
    const RandomWords begin = pixel_counter(address, x);
    std::array<std::array<std::uint32_t, kCounters>, kLanes> c;
    for (std::size_t i = 0; i < counters; ++i) {
      c[0][i] = begin[0] + static_cast<std::uint32_t>(i);
      c[1][i] = begin[1];
      c[2][i] = begin[2];
      c[3][i] = begin[3];
    }
    std::uint32_t key0 = stream.key[0];
    std::uint32_t key1 = stream.key[1];
    for (unsigned round = 0; round < kPhiloxRounds; ++round) {
      for (std::size_t i = 0; i < counters; ++i) {
        const std::uint64_t product0 = kMultiplier0 * c[0][i];
        const std::uint64_t product1 = kMultiplier1 * c[2][i];
        c[0][i] = static_cast<std::uint32_t>(product1 >> kWordBits) ^ c[1][i] ^ key0;
        c[1][i] = static_cast<std::uint32_t>(product1);
        c[2][i] = static_cast<std::uint32_t>(product0 >> kWordBits) ^ c[3][i] ^ key1;
        c[3][i] = static_cast<std::uint32_t>(product0);
      }
      key0 += PHILOX_W32_0;
      key1 += PHILOX_W32_1;
    }
    for (std::size_t i = 0; i < counters; ++i)
      for (std::size_t lane = 0; lane < kLanes; ++lane) words_[kLanes * i + lane] = c[lane][i];
  }
  [[nodiscard]] const std::uint32_t* data() const { return words_.data() + first_; }

 private:
  std::size_t first_;
  std::array<std::uint32_t, kBlock + kLanes> words_;
};

[[gnu::always_inline]] inline void normals_of_words(const std::uint32_t* words, std::size_t size, double* out) {
  DoubleBlock q;
  for (std::size_t i = 0; i < size; ++i) {
    q[i] = normal::centred(words[i]);
    out[i] = normal::central(q[i]);
  }
  IndexBlock tails;
  std::size_t count = 0;
  for (std::size_t i = 0; i < size; ++i) {  // without a branch, which would be mispredicted for 15 % of pixels
    tails[count] = static_cast<std::uint32_t>(i);
    count += std::fabs(q[i]) > normal::kCentralHalfWidth ? 1U : 0U;
  }
  if (count == 0) return;
  // The last one again and again up to whole vectors, which leaves no remainder to a scalar loop.
  const std::size_t padded = (count + kWidestVector - 1) / kWidestVector * kWidestVector;
  for (std::size_t k = count; k < padded; ++k) tails[k] = tails[count - 1];
  DoubleBlock values;
  for (std::size_t k = 0; k < padded; ++k) values[k] = normal::tail(q[tails[k]]);
  for (std::size_t k = 0; k < count; ++k) out[tails[k]] = values[k];
}

/// Calls function(first, words, size) for every block of a row.
template <class Function>
[[gnu::always_inline]] inline void for_each_block(const RandomStream& stream, const PixelAddress& address,
                                                  std::size_t size, Function&& function) {
  for (std::size_t first = 0; first < size; first += kBlock) {
    const std::size_t n = std::min(kBlock, size - first);
    const WordBlock words(stream, address, address.x0 + static_cast<std::int32_t>(first), n);
    function(first, words.data(), n);
  }
}

/// Counts that the high word decides, and otherwise, also for what is no mean, kUndecided.
[[gnu::always_inline]] inline void counts_of_high_words(const std::uint32_t* words, const double* mean,
                                                        std::size_t size, double* out) {
  std::size_t large = 0;
  for (std::size_t i = 0; i < size; ++i) large += mean[i] >= poisson::kSmallMean ? 1U : 0U;
  if (large > 0) {
    DoubleBlock w;
    normals_of_words(words, size, w.data());
    for (std::size_t i = 0; i < size; ++i) out[i] = poisson::quantile_of_normal(mean[i], w[i], words[i]);
  } else {
    std::fill_n(out, size, poisson::kUndecided);
  }
  if (large == size) return;
  DoubleBlock none;
  for (std::size_t i = 0; i < size; ++i) none[i] = inline_exponential(-mean[i]);  // nonsense for large means, unused
  for (std::size_t i = 0; i < size; ++i)
    if (mean[i] >= 0.0 && mean[i] < poisson::kSmallMean)
      out[i] = poisson::quantile_of_high_word_small(mean[i], none[i], words[i]);
}

}  // namespace

ASTROID_WIDE_VECTORS void uniform_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  for_each_block(
      stream, address, out.size(),
      [out](std::size_t first, const std::uint32_t* words, std::size_t size) __attribute__((always_inline)) {
        for (std::size_t i = 0; i < size; ++i) out[first + i] = uniform_from(words[i]);
      });
}

ASTROID_WIDE_VECTORS void normal_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  for_each_block(
      stream, address, out.size(),
      [out](std::size_t first, const std::uint32_t* words, std::size_t size)
          __attribute__((always_inline)) { normals_of_words(words, size, out.data() + first); });
}

ASTROID_WIDE_VECTORS void poisson_row(const RandomStream& stream, const PixelAddress& address,
                                      std::span<const double> mean, std::span<double> out) {
  ASTROID_CHECK_EQ(mean.size(), out.size());
  ASTROID_CHECK_LT(address.draw, std::numeric_limits<std::uint16_t>::max());
  PixelAddress low_address = address;
  ++low_address.draw;
  for_each_block(
      stream, address,
      out.size(), [&](std::size_t first, const std::uint32_t* words, std::size_t size) __attribute__((always_inline)) {
        const double* const m = mean.data() + first;
        DoubleBlock counts;
        counts_of_high_words(words, m, size, counts.data());
        for (std::size_t i = 0; i < size; ++i) {
          if (counts[i] >= 0.0) continue;
          poisson::check_mean(m[i]);
          const std::int32_t x = address.x0 + static_cast<std::int32_t>(first + i);
          const std::uint32_t low =
              philox_words(stream, pixel_counter(low_address, x))[static_cast<std::uint32_t>(x) % kLanes];
          counts[i] = poisson_quantile(m[i], std::uint64_t{words[i]} << kWordBits | low);
        }
        std::copy_n(counts.begin(), size, out.begin() + static_cast<std::ptrdiff_t>(first));
      });
}

}  // namespace astroid
