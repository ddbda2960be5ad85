// CHECKSUM and DATASUM of FITS files. @source Pence2010 Appendix J
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace astroid {

/// Where one header-data unit lies in its file; bytes. Data are padded to whole blocks.
struct FitsUnitExtent {
  std::int64_t header = 0;
  std::int64_t data = 0;
  std::int64_t end = 0;
};

/// The 32-bit ones'-complement sum of big-endian words, added to `sum`. The number of bytes must be a multiple of 4.
[[nodiscard]] std::uint32_t fits_sum(std::string_view bytes, std::uint32_t sum);

/// The 16 characters that make a unit of that sum add up to -0.
[[nodiscard]] std::string encode_fits_checksum(std::uint32_t sum);

/// Fills the CHECKSUM and DATASUM cards of a unit's header, which must hold them, from the sum of its data.
void fill_fits_checksums(std::string& header, std::uint32_t data_sum);

/// Fills the CHECKSUM and DATASUM cards, which every header must already hold, of a complete file; a file that ends
/// before the last unit's end is extended with zeros. Not by CFITSIO: its function puts the time of day into the
/// comments and reads large images slowly.
/// @throws std::system_error
void write_fits_checksums(int descriptor, std::span<const FitsUnitExtent> units);

}  // namespace astroid
