// Where the words of pixels come from, one pixel at a time (docs/random-numbers.md), and checks that all kernels share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "astroid/core/error.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "philox.hpp"

namespace astroid {

inline constexpr unsigned kLaneBits = 2;  // Philox gives four words per counter: four neighbouring columns
inline constexpr std::size_t kWordsOfCounter = 1U << kLaneBits;

/// The counter of the four pixels that column x belongs to.
inline RandomWords pixel_counter(const PixelAddress& address, std::int32_t x) {
  constexpr unsigned kHalfWordBits = 16;
  return {static_cast<std::uint32_t>(x >> kLaneBits), static_cast<std::uint32_t>(address.y), address.exposure,
          std::uint32_t{address.read} << kHalfWordBits | address.draw};
}

/// The word of the pixel at address.x0.
inline std::uint32_t pixel_word(const RandomStream& stream, const PixelAddress& address) {
  return philox_words(stream,
                      pixel_counter(address, address.x0))[static_cast<std::uint32_t>(address.x0) % kWordsOfCounter];
}

/// Pixels in a row. @throws BugError when the rows are not whole.
inline std::size_t pixel_columns(const PixelRows& pixels, std::size_t count) {
  if (count == 0) return 0;
  ASTROID_CHECK_LT(0U, pixels.rows);
  ASTROID_CHECK_EQ(count % pixels.rows, 0U);
  return count / pixels.rows;
}

/// The address of pixel i of rows of nx pixels.
inline PixelAddress pixel_at(const PixelRows& pixels, std::size_t nx, std::size_t i) {
  PixelAddress address = pixels.address;
  address.x0 += static_cast<std::int32_t>(i % nx);
  address.y += static_cast<std::int32_t>(i / nx);
  return address;
}

inline void check_poisson(const PixelRows& pixels, std::span<const double> mean, std::span<double> counts) {
  ASTROID_CHECK_EQ(mean.size(), counts.size());
  ASTROID_CHECK_LT(pixels.address.draw, std::numeric_limits<std::uint16_t>::max());
}

/// The count where the word `high` of this pixel may leave it open: the word of the next draw decides.
inline double poisson_at_pixel(const RandomStream& stream, PixelAddress address, double mean, std::uint32_t high) {
  return poisson_quantile(mean, high, [&] {
    ++address.draw;
    return pixel_word(stream, address);
  });
}

}  // namespace astroid
