#include "fits_large_image.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <system_error>
#include <type_traits>

namespace astroid {

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 16U;

[[noreturn]] void fail() {
  throw std::system_error(errno, std::generic_category());
}

template <std::size_t Size>
using Word = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

std::uint8_t big_endian(std::uint8_t word) {
  return word;
}
std::uint16_t big_endian(std::uint16_t word) {
  return __builtin_bswap16(word);
}
std::uint32_t big_endian(std::uint32_t word) {
  return __builtin_bswap32(word);
}
std::uint64_t big_endian(std::uint64_t word) {
  return __builtin_bswap64(word);
}

template <class T>
void write_numbers(int descriptor, std::int64_t at, std::span<const T> values) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::uint16_t kUnsignedOffset = 0x8000;
  std::array<Word<sizeof(T)>, kBlockBytes / sizeof(T)> block;
  while (!values.empty()) {
    const std::size_t count = std::min(values.size(), block.size());
    for (std::size_t i = 0; i < count; ++i) {
      auto word = std::bit_cast<Word<sizeof(T)>>(values[i]);
      if constexpr (std::is_same_v<T, std::uint16_t>) word = static_cast<std::uint16_t>(word ^ kUnsignedOffset);
      block[i] = big_endian(word);
    }
    const char* bytes = reinterpret_cast<const char*>(block.data());
    std::size_t rest = count * sizeof(T);
    while (rest > 0) {
      const ssize_t written = ::pwrite(descriptor, bytes, rest, at);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail();
      bytes += written;
      at += written;
      rest -= static_cast<std::size_t>(written);
    }
    values = values.subspan(count);
  }
}

}  // namespace

void set_file_size(int descriptor, std::int64_t size) {
  // fallocate() tells at once when the disk is too small; file systems that do not know it get a file with holes.
  if (::fallocate(descriptor, 0, 0, size) == 0) return;
  if (errno != EOPNOTSUPP && errno != ENOSYS) fail();
  if (::ftruncate(descriptor, size) != 0) fail();
}

void write_fits_numbers(int descriptor, std::int64_t at, std::span<const std::uint8_t> values) {
  write_numbers(descriptor, at, values);
}
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const std::uint16_t> values) {
  write_numbers(descriptor, at, values);
}
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const std::int32_t> values) {
  write_numbers(descriptor, at, values);
}
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const float> values) {
  write_numbers(descriptor, at, values);
}
void write_fits_numbers(int descriptor, std::int64_t at, std::span<const double> values) {
  write_numbers(descriptor, at, values);
}

}  // namespace astroid
