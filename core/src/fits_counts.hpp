// Counts as FITS stores them.
#pragma once

#include <cstdint>
#include <span>

namespace astroid {

/// Converts whole numbers to big-endian integers: 16-bit ones offset by 32768 (BZERO), or 32-bit ones.
/// @param stored  as many as counts.  @returns whether every count was whole and in range; else `stored` is undefined.
[[nodiscard]] bool store_fits_counts(std::span<const float> counts, std::span<std::uint16_t> stored);
[[nodiscard]] bool store_fits_counts(std::span<const float> counts, std::span<std::uint32_t> stored);

}  // namespace astroid
