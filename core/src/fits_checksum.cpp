#include "fits_checksum.hpp"

#include <fitsio.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr std::size_t kCardLength = 80;                 // characters, FITS standard
constexpr std::size_t kValueColumn = 10;                // where a card's value begins, from 0
constexpr std::size_t kChunk = std::size_t{2880} * 91;  // bytes read at a time, about 256 KiB: within fast caches

[[noreturn]] void fail() {
  throw std::system_error(errno, std::generic_category());
}

void read_bytes(int descriptor, std::int64_t begin, std::span<char> bytes) {
  const std::size_t count = bytes.size();
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor, bytes.data() + done, count - done, begin + static_cast<std::int64_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail();
    if (got == 0) throw BugError("FITS checksum: the file ends early");
    done += static_cast<std::size_t>(got);
  }
}

void set_text_value(std::string& header, std::string_view key, std::string_view value) {
  for (std::size_t at = 0; at < header.size(); at += kCardLength) {
    if (header.compare(at, key.size(), key) != 0) continue;
    const std::string quoted = fmt::format("'{}'", value);
    header.replace(at + kValueColumn, quoted.size(), quoted);
    return;
  }
  throw BugError(fmt::format("FITS checksum: no card {}", key));
}

}  // namespace

std::uint32_t fits_sum(std::string_view bytes, std::uint32_t sum) {
  ASTROID_CHECK_EQ(bytes.size() % sizeof(std::uint32_t), std::size_t{0});
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t total = sum;
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint32_t)) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + i, sizeof word);
    total += __builtin_bswap32(word);  // this, unlike single bytes, becomes vector code
  }
  while (total >> 32U != 0) total = (total & 0xFFFFFFFFU) + (total >> 32U);  // carries come in again at the low end
  return static_cast<std::uint32_t>(total);
}

std::string encode_fits_checksum(std::uint32_t sum) {
  std::array<char, FLEN_VALUE> text{};
  fits_encode_chksum(sum, 1, text.data());
  return text.data();
}

void fill_fits_checksums(std::string& header, std::uint32_t data_sum) {
  constexpr std::size_t kLongestSum = 10;  // digits of a 32-bit number: the blanks overwrite an older, longer one
  set_text_value(header, "DATASUM ", fmt::format("{:<{}}", data_sum, kLongestSum));
  set_text_value(header, "CHECKSUM", std::string(16, '0'));
  set_text_value(header, "CHECKSUM", encode_fits_checksum(fits_sum(header, data_sum)));
}

void write_fits_checksums(int descriptor, std::span<const FitsUnitExtent> units) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail();
  if (!units.empty() && status.st_size < units.back().end && ::ftruncate(descriptor, units.back().end) != 0) fail();
  std::vector<char> chunk(kChunk);
  for (const FitsUnitExtent& unit : units) {
    std::uint32_t data_sum = 0;
    for (std::int64_t at = unit.data; at < unit.end; at += static_cast<std::int64_t>(kChunk)) {
      const std::span<char> bytes = std::span(chunk).first(std::min(kChunk, static_cast<std::size_t>(unit.end - at)));
      read_bytes(descriptor, at, bytes);
      data_sum = fits_sum({bytes.data(), bytes.size()}, data_sum);
    }
    std::string header(static_cast<std::size_t>(unit.data - unit.header), '\0');
    read_bytes(descriptor, unit.header, header);
    fill_fits_checksums(header, data_sum);
    const ssize_t written = ::pwrite(descriptor, header.data(), header.size(), unit.header);
    if (written < 0) fail();
    if (static_cast<std::size_t>(written) != header.size()) throw std::system_error(ENOSPC, std::generic_category());
  }
}

}  // namespace astroid
