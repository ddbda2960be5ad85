#include "astroid/photometry/background.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class Value>
Frame frame_with(int nx, int ny, Value value) {
  Frame frame = test::empty_frame(test::full_frame(nx, ny));
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) frame.pixels.view(0).at(x, y) = static_cast<float>(value(x, y));
  return frame;
}

std::vector<double> level_of(const BackgroundMap& map, int y) {
  std::vector<double> row(static_cast<std::size_t>(map.area().nx));
  map.level_row(y, row);
  return row;
}

TEST(SmoothedMedian, IsTheMedianOfDistinctValues) {
  EXPECT_EQ(smoothed_median(std::vector<double>{1.0, 2.0, 4.0}), 2.0);
  EXPECT_EQ(smoothed_median(std::vector<double>{1.0, 2.0, 4.0, 9.0}), 3.0);
  EXPECT_EQ(smoothed_median(std::vector<double>{5.0}), 5.0);
  EXPECT_EQ(smoothed_median(std::vector<double>{5.0, 5.0, 5.0}), 5.0);
  EXPECT_TRUE(std::isnan(smoothed_median({})));
}

TEST(SmoothedMedian, SeesBelowTheQuantisationStep) {
  const test::TestNoise noise(7);
  for (const double truth : {100.0, 100.2, 100.37, 100.5, 100.8}) {
    std::vector<double> values;
    for (std::uint32_t i = 0; i < 20000; ++i) values.push_back(std::floor(truth + 1.5 * noise.normal(1, i) + 0.5));
    std::sort(values.begin(), values.end());
    // The noise of a median of 20,000 values of 1.5 rms is 0.0133; the plain median is wrong by up to 0.5.
    EXPECT_NEAR(smoothed_median(values), truth, 4 * 0.0133);
  }
}

TEST(ClippedSky, ClipsNothingOfAConstant) {
  std::vector<double> values(10000, 7.25);
  const SkyEstimate sky = clipped_sky(values, 3.0, true);
  EXPECT_EQ(sky.level, 7.25);
  EXPECT_EQ(sky.rms, 0.0);
  EXPECT_EQ(sky.pixels, 10000U);
}

TEST(ClippedSky, ClipsExactlyTheOneOutlier) {
  std::vector<double> values(10000, 7.25);
  values[123] = 1e9;
  const SkyEstimate sky = clipped_sky(values, 3.0, false);
  EXPECT_EQ(sky.level, 7.25);
  EXPECT_EQ(sky.pixels, 9999U);
}

TEST(ClippedSky, OfNoValuesIsNotANumber) {
  std::vector<double> none;
  EXPECT_TRUE(std::isnan(clipped_sky(none, 3.0, true).level));
}

TEST(ClippedSky, IsUnbiasedForNormalNoise) {
  const test::TestNoise noise(8);
  std::vector<double> values;
  constexpr std::uint32_t kCount = 100000;
  for (std::uint32_t i = 0; i < kCount; ++i) values.push_back(50.0 + 4.0 * noise.normal(2, i));
  const SkyEstimate sky = clipped_sky(values, 3.0, false);
  EXPECT_NEAR(sky.level, 50.0, 4 * 1.2533 * 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(sky.rms / 4.0, 1.0, 4 / std::sqrt(2.0 * kCount)) << "the cut tails alone would lower it by 1.5 %";
}

TEST(BackgroundMap, OfAConstantIsTheConstant) {
  const Frame frame = frame_with(100, 70, [](int, int) { return 321.5; });
  const BackgroundMap map(frame, 0, {.cell = 16});
  for (const int y : {0, 35, 69})
    for (const double level : level_of(map, y)) EXPECT_DOUBLE_EQ(level, 321.5);
  EXPECT_EQ(map.median_level(), 321.5);
  EXPECT_EQ(map.median_rms(), 0.0);
}

TEST(BackgroundMap, FollowsAGradient) {
  const Frame frame = frame_with(160, 160, [](int x, int y) { return 100.0 + 0.2 * x - 0.1 * y; });
  const BackgroundMap map(frame, 0, {.cell = 16, .filter = 3});
  for (const int y : {0, 40, 159}) {
    const std::vector<double> level = level_of(map, y);
    for (std::size_t x = 0; x < level.size(); ++x)
      EXPECT_NEAR(level[x], 100.0 + 0.2 * static_cast<double>(x) - 0.1 * y, 1e-4);
  }
}

TEST(BackgroundMap, IgnoresStarsAndFlaggedPixels) {
  const test::TestNoise noise(9);
  Frame frame = frame_with(
      128, 128, [&](int x, int y) { return 1000.0 + 5.0 * noise.normal(3, static_cast<std::uint32_t>(128 * y + x)); });
  for (int k = 0; k < 40; ++k) {
    const int x = (k * 37) % 126;
    const int y = (k * 53) % 126;
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) frame.pixels.view(0).at(x + a, y + b) += 3000.0F;
  }
  for (int i = 0; i < 128; ++i) frame.pixels.view(0).at(i, 17) = kNan;
  for (int i = 0; i < 128; ++i) {
    frame.pixels.view(0).at(50, i) = 65535.0F;
    frame.flags.view(0).at(50, i) = pixel_flag::kAdcSaturated;
  }
  const BackgroundMap map(frame, 0, {.cell = 32});
  for (const int y : {0, 17, 64, 127})
    for (const double level : level_of(map, y)) EXPECT_NEAR(level, 1000.0, 1.0);
  EXPECT_NEAR(map.median_rms(), 5.0, 0.3);
}

TEST(BackgroundMap, FillsCellsWithoutPixelsFromTheirNeighbours) {
  Frame frame = frame_with(96, 96, [](int, int) { return 40.0; });
  for (int y = 32; y < 64; ++y)
    for (int x = 32; x < 64; ++x) frame.flags.view(0).at(x, y) = pixel_flag::kBad;
  for (const double level : level_of(BackgroundMap(frame, 0, {.cell = 32}), 48)) EXPECT_DOUBLE_EQ(level, 40.0);
}

TEST(BackgroundMap, WithoutAnyPixelIsNotANumber) {
  const Frame frame = frame_with(50, 40, [](int, int) { return kNan; });
  for (const double level : level_of(BackgroundMap(frame, 0, {.cell = 16}), 3)) EXPECT_TRUE(std::isnan(level));
}

TEST(BackgroundMap, CopesWithTheSmallestImages) {
  for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 200}, {200, 1}, {63, 65}}) {
    const Frame frame = frame_with(nx, ny, [](int, int) { return 5.5; });
    const BackgroundMap map(frame, 0, {});
    for (const double level : level_of(map, ny - 1)) EXPECT_DOUBLE_EQ(level, 5.5);
  }
}

TEST(BackgroundMap, RefusesAMeshWithoutSize) {
  const Frame frame = frame_with(8, 8, [](int, int) { return 1.0; });
  EXPECT_THROW(BackgroundMap(frame, 0, {.cell = 0}), InputError);
  EXPECT_THROW(BackgroundMap(frame, 0, {.cell = 8, .filter = 0}), InputError);
  EXPECT_THROW(BackgroundMap(frame, 0, {.cell = 8, .filter = 3, .clip = -1.0}), InputError);
}

TEST(SubtractBackground, LeavesTheBias) {
  Frame frame = frame_with(64, 64, [](int, int) { return 1040.0; });
  frame.header.bias = Adu(1000.0);
  const BackgroundMap map(frame, 0, {.cell = 32});
  subtract_background(frame, 0, map);
  for (const float value : frame.pixels.pixels()) EXPECT_FLOAT_EQ(value, 1000.0F);
}

TEST(AnnulusBackground, HasAnHonestError) {
  const test::TestNoise noise(10);
  double squares = 0.0;
  double predicted = 0.0;
  constexpr std::uint32_t kRealisations = 1000;
  for (std::uint32_t k = 0; k < kRealisations; ++k) {
    const Frame frame = frame_with(
        25, 25, [&](int x, int y) { return 200.0 + 3.0 * noise.normal(k, static_cast<std::uint32_t>(25 * y + x)); });
    const AnnulusBackground sky = annulus_background(frame, 0, {12.2, 11.9}, 5.0, 8.0);
    squares += (sky.level - 200.0) * (sky.level - 200.0);
    predicted += sky.error * sky.error;
  }
  // The scatter of a standard deviation of 1000 values is 2.2 %.
  EXPECT_NEAR(std::sqrt(squares / predicted), 1.0, 0.09);
}

TEST(AnnulusBackground, NeedsEnoughPixels) {
  const Frame frame = frame_with(9, 9, [](int, int) { return 3.0; });
  EXPECT_TRUE(std::isnan(annulus_background(frame, 0, {4.0, 4.0}, 5.5, 8.0).level));
  EXPECT_TRUE(std::isnan(annulus_background(frame, 0, {400.0, 4.0}, 1.0, 3.0).level));
  EXPECT_EQ(annulus_background(frame, 0, {4.0, 4.0}, 1.0, 4.0).level, 3.0);
}

}  // namespace
}  // namespace astroid
