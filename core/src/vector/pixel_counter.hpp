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

/// @throws BugError when the areas have another number of pixels.
inline void check_size(const PixelPlaces& pixels, std::size_t count) {
  std::size_t size = 0;
  for (const Rectangle& area : pixels.areas) size += area.size();
  ASTROID_CHECK_EQ(size, count);
}

/// The address of the pixel at (x, y).
inline PixelAddress address_of(const PixelPlaces& pixels, int x, int y) {
  return {.x0 = x, .y = y, .exposure = pixels.exposure, .read = pixels.read, .draw = pixels.draw};
}

/// The address of pixel i, counted through the areas.
inline PixelAddress pixel_at(const PixelPlaces& pixels, std::size_t i) {
  for (const Rectangle& area : pixels.areas) {
    if (i >= area.size()) {
      i -= area.size();
      continue;
    }
    const auto width = static_cast<std::size_t>(area.nx);
    return address_of(pixels, area.x0 + static_cast<int>(i % width), area.y0 + static_cast<int>(i / width));
  }
  throw BugError("a pixel beyond the areas");
}

inline void check_poisson(const PixelPlaces& pixels, std::span<const double> mean, std::span<double> counts) {
  check_size(pixels, mean.size());
  ASTROID_CHECK_EQ(mean.size(), counts.size());
  ASTROID_CHECK_LT(pixels.draw, std::numeric_limits<std::uint16_t>::max());
}

/// The count where the word `high` of this pixel may leave it open: the word of the next draw decides.
inline double poisson_at_pixel(const RandomStream& stream, PixelAddress address, double mean, std::uint32_t high) {
  return poisson_quantile(mean, high, [&] {
    ++address.draw;
    return pixel_word(stream, address);
  });
}

}  // namespace astroid
