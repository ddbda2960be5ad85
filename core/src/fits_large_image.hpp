// Pixels of images larger than memory, written past CFITSIO.
#pragma once

#include <cstdint>
#include <span>

namespace astroid {

/// Sets aside space for a file of `size` bytes, holes reading as 0. @throws std::system_error, a full disk included.
void set_file_size(int descriptor, std::int64_t size);

/// Writes numbers as FITS stores them (big-endian; unsigned 16-bit ones offset by 32768) at a byte of the file.
/// @throws std::system_error
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const std::uint8_t> values);
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const std::uint16_t> values);
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const std::int32_t> values);
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const float> values);
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const double> values);

}  // namespace astroid
