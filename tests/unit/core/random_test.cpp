#include "astroid/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr StreamId kEffect{7};

TEST(Philox, GivesTheKnownAnswersOfRandom123) {
  std::ifstream file(test::source_dir() / "tests/unit/core/data/philox4x32_10.txt");
  int vectors = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    words >> std::hex;
    RandomWords counter{};
    RandomStream stream;
    RandomWords expected{};
    for (auto& word : counter) words >> word;
    for (auto& word : stream.key) words >> word;
    for (auto& word : expected) words >> word;
    ASSERT_TRUE(words) << line;
    EXPECT_EQ(philox4x32(stream, counter), expected) << line;
    ++vectors;
  }
  EXPECT_EQ(vectors, 3);
}

// The key by the definition in docs/random-numbers.md, in another language (Python integers). A promise: never update.
TEST(RandomStream, KeysArePartOfThePromise) {
  EXPECT_EQ(make_stream(0, StreamId{0}, 0, 0).key, (std::array<std::uint32_t, 2>{0xaac80268U, 0x2130748aU}));
  EXPECT_EQ(make_stream(20240229, StreamId{7}, 3, 1).key, (std::array<std::uint32_t, 2>{0xac35c62fU, 0xdc073374U}));
  EXPECT_EQ(make_stream(0xfedcba9876543210U, StreamId{12}, 24, 4).key,
            (std::array<std::uint32_t, 2>{0xdad93bcaU, 0x3b9554e1U}));
}

TEST(RandomStream, EveryFieldMakesADifferentKey) {
  std::set<std::array<std::uint32_t, 2>> keys;
  std::size_t count = 0;
  for (std::uint64_t seed : {0U, 1U, 2U, 3U})
    for (std::uint32_t effect = 0; effect < 16; ++effect)
      for (std::uint32_t camera = 0; camera < 16; ++camera)
        for (std::uint32_t detector = 0; detector < 4; ++detector, ++count)
          keys.insert(make_stream(seed, StreamId{effect}, camera, detector).key);
  EXPECT_EQ(keys.size(), count);
}

TEST(PixelAddress, IsLaidOutAsDocumented) {
  const RandomStream stream = make_stream(1, kEffect, 2, 3);
  const std::uint32_t exposure = 5;
  for (const auto& [x, group, lane] : std::vector<std::tuple<std::int32_t, std::uint32_t, std::size_t>>{
           {0, 0U, 0U}, {3, 0U, 3U}, {4, 1U, 0U}, {4511, 1127U, 3U}, {-1, 0xffffffffU, 3U}, {-5, 0xfffffffeU, 3U}}) {
    for (const auto& [y, row] : std::vector<std::pair<std::int32_t, std::uint32_t>>{{0, 0U}, {-2, 0xfffffffeU}}) {
      double value = 0.0;
      uniform_row(stream, {x, y, exposure, 6, 9}, {&value, 1});
      const RandomWords words = philox4x32(stream, {group, row, exposure, 6U << 16U | 9U});
      EXPECT_EQ(value, uniform_from(words[lane])) << "x " << x << " y " << y;
    }
  }
}

TEST(SourceAddress, IsLaidOutAsDocumented) {
  const RandomStream stream = make_stream(1, kEffect, 2, 3);
  const RandomWords words = philox4x32(stream, {0x89abcdefU, 0x01234567U, 5, 6U << 16U | 9U});
  const std::uint64_t word = std::uint64_t{words[0]} << 32U | words[1];
  const SourceAddress address{0x0123456789abcdefU, 5, 6, 9};
  EXPECT_EQ(uniform_for_source(stream, address), uniform_from(word));
  EXPECT_EQ(normal_for_source(stream, address), standard_normal(word));
  EXPECT_EQ(poisson_for_source(stream, address, 1e12), poisson_quantile(1e12, word));
}

TEST(StepAddress, IsLaidOutAsDocumented) {
  const RandomStream stream = make_stream(1, kEffect, 0, 0);
  const RandomWords words = philox4x32(stream, {0x89abcdefU, 0x01234567U, 2, 4});
  const std::uint64_t word = std::uint64_t{words[0]} << 32U | words[1];
  const StepAddress address{0x0123456789abcdefU, 2, 4};
  EXPECT_EQ(uniform_at_step(stream, address), uniform_from(word));
  EXPECT_EQ(normal_at_step(stream, address), standard_normal(word));
  EXPECT_EQ(poisson_at_step(stream, address, 1e12), poisson_quantile(1e12, word));
}

class AnyWindow : public testing::TestWithParam<double> {};

TEST_P(AnyWindow, GivesAPixelTheSameBits) {
  constexpr std::int32_t kFirst = -150;
  constexpr std::size_t kColumns = 400;
  const RandomStream stream = make_stream(3, kEffect, 0, 0);
  const std::vector<double> mean(kColumns, GetParam());
  std::vector<double> uniform(kColumns);
  std::vector<double> normal(kColumns);
  std::vector<double> poisson(kColumns);
  uniform_row(stream, {kFirst, 11, 2, 0, 0}, uniform);
  normal_row(stream, {kFirst, 11, 2, 0, 0}, normal);
  poisson_row(stream, {kFirst, 11, 2, 0, 0}, mean, poisson);
  for (std::size_t first = 0; first < 9; ++first) {
    for (std::size_t size : {0U, 1U, 2U, 3U, 4U, 5U, 63U, 64U, 65U, 130U, 391U}) {
      const PixelAddress address{kFirst + static_cast<std::int32_t>(first), 11, 2, 0, 0};
      std::vector<double> part(size);
      uniform_row(stream, address, part);
      for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(part[i], uniform[first + i]) << first << ' ' << size << ' ' << i;
      normal_row(stream, address, part);
      for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(part[i], normal[first + i]) << first << ' ' << size << ' ' << i;
      poisson_row(stream, address, std::span(mean).first(size), part);
      for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(part[i], poisson[first + i]) << first << ' ' << size << ' ' << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Means, AnyWindow, testing::Values(0.0, 0.7, 12.0, 1300.0, 1e14));

// Rows may be computed in blocks; the value is that of the scalar functions on the words of the address.
TEST(PoissonRow, UsesTheNextDrawForTheLowWordOnly) {
  const RandomStream stream = make_stream(3, kEffect, 0, 0);
  for (const double mean : {0.0, 1e-9, 0.3, 9.99, 10.0, 1300.0, 1e10, 1e15}) {
    const std::vector<double> means(1000, mean);
    std::vector<double> counts(means.size());
    std::vector<double> normals(means.size());
    poisson_row(stream, {-7, 5, 1, 2, 3}, means, counts);
    normal_row(stream, {-7, 5, 1, 2, 3}, normals);
    for (std::int32_t i = 0; i < 1000; ++i) {
      const std::int32_t x = i - 7;
      const auto word = [&](std::uint32_t draw) {
        return philox4x32(
            stream, {static_cast<std::uint32_t>(x >> 2), 5, 1, 2U << 16U | draw})[static_cast<std::uint32_t>(x) % 4U];
      };
      ASSERT_EQ(counts[static_cast<std::size_t>(i)], poisson_quantile(mean, word(3), [&] { return word(4); })) << x;
      ASSERT_EQ(counts[static_cast<std::size_t>(i)], poisson_quantile(mean, std::uint64_t{word(3)} << 32U | word(4)))
          << x;
      ASSERT_EQ(normals[static_cast<std::size_t>(i)], standard_normal(word(3))) << x;
    }
  }
}

// A different processor, emulator, compiler or vector width must print the same number: a promise, so never update.
TEST(Rows, HaveTheSameBitsEverywhere) {
  constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325U;  // FNV-1a, 64 bits
  constexpr std::uint64_t kFnvPrime = 0x100000001b3U;
  std::uint64_t hash = kFnvBasis;
  const auto add = [&hash](double value) { hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * kFnvPrime; };
  const RandomStream stream = make_stream(20260101, kEffect, 1, 2);
  std::vector<double> mean(1000);
  std::vector<double> out(1000);
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = static_cast<double>(i * i * i * i) / 1024.0;  // 0 .. 1e9
  for (std::int32_t y = 0; y < 100; ++y) {
    uniform_row(stream, {-3, y, 1, 0, 0}, out);
    for (const double value : out) add(value);
    normal_row(stream, {-3, y, 1, 0, 0}, out);
    for (const double value : out) add(value);
    poisson_row(stream, {-3, y, 1, 0, 1}, mean, out);
    for (const double value : out) add(value);
    add(normal_at_step(stream, {static_cast<std::uint64_t>(y), 0, 0}));
  }
  EXPECT_EQ(hash, 0xc84fcdccd0da8d96U) << std::hex << hash;
}

TEST(PoissonRow, RefusesWhatHasNoLowWord) {
  const std::vector<double> mean(3, 1.0);
  std::vector<double> out(3);
  EXPECT_THROW(poisson_row({}, {0, 0, 0, 0, 65535}, mean, out), BugError);
  EXPECT_THROW(poisson_row({}, {}, mean, std::span(out).first(2)), BugError);
}

TEST(Uniforms, StayInsideTheOpenInterval) {
  EXPECT_EQ(uniform_from(0U), 0x1p-33);
  EXPECT_EQ(uniform_from(0xffffffffU), 1.0 - 0x1p-33);
  EXPECT_EQ(uniform_from(std::uint64_t{0}), 0x1p-53);
  EXPECT_EQ(uniform_from(~std::uint64_t{0}), 1.0 - 0x1p-53);
}

}  // namespace
}  // namespace astroid
