#include "astroid/core/distributions.hpp"

#include <cstddef>
#include <limits>

#include "astroid/core/error.hpp"
#include "normal_quantile.hpp"
#include "philox.hpp"
#include "poisson_quantile.hpp"

namespace astroid {

namespace {

constexpr unsigned kWordBits = 32;
constexpr unsigned kHalfWordBits = 16;
constexpr unsigned kLaneBits = 2;  // Philox gives four words per counter: four neighbouring columns
constexpr std::size_t kLanes = 1U << kLaneBits;

std::uint64_t join(std::uint32_t high, std::uint32_t low) {
  return std::uint64_t{high} << kWordBits | low;
}

std::uint32_t join_halves(std::uint16_t read, std::uint16_t draw) {
  return std::uint32_t{read} << kHalfWordBits | draw;
}

/// The counter of the four pixels that column x belongs to.
RandomWords pixel_counter(const PixelAddress& address, std::int32_t x) {
  return {static_cast<std::uint32_t>(x >> kLaneBits), static_cast<std::uint32_t>(address.y), address.exposure,
          join_halves(address.read, address.draw)};
}

RandomWords source_words(const RandomStream& stream, const SourceAddress& address) {
  return philox_words(stream,
                      {static_cast<std::uint32_t>(address.hash), static_cast<std::uint32_t>(address.hash >> kWordBits),
                       address.exposure, join_halves(address.read, address.draw)});
}

RandomWords step_words(const RandomStream& stream, const StepAddress& address) {
  return philox_words(stream, {static_cast<std::uint32_t>(address.step),
                               static_cast<std::uint32_t>(address.step >> kWordBits), address.axis, address.draw});
}

/// Calls function(i, counter, lane, word) for every pixel i of a row; the words of four columns are made at once.
template <class Function>
void for_each_word(const RandomStream& stream, const PixelAddress& address, std::size_t size, Function&& function) {
  std::size_t i = 0;
  std::size_t lane = static_cast<std::uint32_t>(address.x0) % kLanes;
  RandomWords counter = pixel_counter(address, address.x0);
  while (i < size) {
    const RandomWords words = philox_words(stream, counter);
    for (; lane < kLanes && i < size; ++lane, ++i) function(i, counter, lane, words[lane]);
    lane = 0;
    ++counter[0];
  }
}

}  // namespace

double uniform_from(std::uint32_t word) {
  return (static_cast<double>(word) + 0.5) * 0x1p-32;
}

double uniform_from(std::uint64_t word) {
  constexpr unsigned kDropped = 12;  // with the half, the remaining 52 bits fill a double exactly
  return (static_cast<double>(word >> kDropped) + 0.5) * 0x1p-52;
}

double standard_normal(std::uint32_t word) {
  return normal::quantile(word);
}
double standard_normal(std::uint64_t word) {
  return normal::quantile(word);
}

void uniform_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  for_each_word(stream, address, out.size(), [out](std::size_t i, const RandomWords&, std::size_t, std::uint32_t word) {
    out[i] = uniform_from(word);
  });
}

void normal_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  for_each_word(stream, address, out.size(), [out](std::size_t i, const RandomWords&, std::size_t, std::uint32_t word) {
    out[i] = normal::quantile(word);
  });
}

void poisson_row(const RandomStream& stream, const PixelAddress& address, std::span<const double> mean,
                 std::span<double> out) {
  ASTROID_CHECK_EQ(mean.size(), out.size());
  ASTROID_CHECK_LT(address.draw, std::numeric_limits<std::uint16_t>::max());
  for_each_word(stream, address, out.size(),
                [&](std::size_t i, const RandomWords& counter, std::size_t lane, std::uint32_t word) {
                  const double m = mean[i];
                  if (!(m >= 0.0 && m <= kLargestPoissonMean)) poisson::check_mean(m);
                  double count = poisson::quantile_of_high_word(m, word);
                  if (count < 0.0) {
                    RandomWords next = counter;
                    ++next[3];  // draw + 1: cannot carry into the read, since draw < 65535
                    count = poisson_quantile(m, join(word, philox_words(stream, next)[lane]));
                  }
                  out[i] = count;
                });
}

double uniform_for_source(const RandomStream& stream, const SourceAddress& address) {
  const RandomWords words = source_words(stream, address);
  return uniform_from(join(words[0], words[1]));
}

double normal_for_source(const RandomStream& stream, const SourceAddress& address) {
  const RandomWords words = source_words(stream, address);
  return standard_normal(join(words[0], words[1]));
}

double poisson_for_source(const RandomStream& stream, const SourceAddress& address, double mean) {
  const RandomWords words = source_words(stream, address);
  return poisson_quantile(mean, words[0], [&words] { return words[1]; });
}

double uniform_at_step(const RandomStream& stream, const StepAddress& address) {
  const RandomWords words = step_words(stream, address);
  return uniform_from(join(words[0], words[1]));
}

double normal_at_step(const RandomStream& stream, const StepAddress& address) {
  const RandomWords words = step_words(stream, address);
  return standard_normal(join(words[0], words[1]));
}

double poisson_at_step(const RandomStream& stream, const StepAddress& address, double mean) {
  const RandomWords words = step_words(stream, address);
  return poisson_quantile(mean, words[0], [&words] { return words[1]; });
}

}  // namespace astroid
