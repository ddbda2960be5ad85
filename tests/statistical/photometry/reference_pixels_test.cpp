// Levels of reference pixels: unbiased, with the variance of a mean, and deaf to cosmic rays.
#include "astroid/photometry/reference_pixels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "astroid/core/distributions.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 4000;
constexpr int kRows = 30;
constexpr double kGain = 25.0;
constexpr double kReadout = 50.2;  // e-
constexpr double kBias = 1000.0;

ReferenceNoise plato_noise() {
  return {.readout = std::sqrt(kReadout * kReadout / (kGain * kGain) + 1.0 / 12.0), .gain = kGain, .bias = kBias};
}

// Overscan rows with `electrons` smeared into each pixel.
Image<float, unit::Adu> overscan(double electrons, std::uint32_t exposure) {
  Image<float, unit::Adu> image({0, 4510, kColumns, kRows});
  const RandomStream photons = make_stream(5, StreamId{1}, 0, 0);
  const RandomStream readout = make_stream(5, StreamId{2}, 0, 0);
  const std::vector<double> mean(kColumns, electrons);
  std::vector<double> drawn(kColumns);
  std::vector<double> noise(kColumns);
  for (int y = 4510; y < 4510 + kRows; ++y) {
    poisson_row(photons, {0, y, exposure, 0, 0}, mean, drawn);
    normal_row(readout, {0, y, exposure, 0, 0}, noise);
    for (std::size_t x = 0; x < kColumns; ++x)
      image.row(y)[x] = static_cast<float>(std::nearbyint((drawn[x] + kReadout * noise[x]) / kGain + kBias));
  }
  return image;
}

struct Scatter {
  double mean = 0.0;
  double variance = 0.0;
};

Scatter scatter_of(std::span<const double> values, double about) {
  Scatter s;
  for (const double v : values) s.mean += (v - about) / static_cast<double>(values.size());
  for (const double v : values)
    s.variance += (v - about - s.mean) * (v - about - s.mean) / static_cast<double>(values.size() - 1);
  return s;
}

TEST(ColumnLevels, AreUnbiasedWithTheVarianceOfAMean) {
  for (const double electrons : {0.0, 3.0, 180.0, 14880.0}) {
    const Image<float, unit::Adu> image = overscan(electrons, 0);
    std::vector<double> levels(kColumns);
    column_levels(image.view(), plato_noise(), levels);
    const Scatter s = scatter_of(levels, kBias + electrons / kGain);
    const double expected = ((kReadout * kReadout + electrons) / (kGain * kGain) + 1.0 / 12.0) / kRows;
    const double z_mean = s.mean / std::sqrt(expected / kColumns);
    const double z_variance = (s.variance / expected - 1.0) / std::sqrt(2.0 / (kColumns - 1));
    std::printf("%8.0f e-: z of the mean %+.2f, of the variance %+.2f\n", electrons, z_mean, z_variance);
    EXPECT_LT(std::fabs(z_mean), 4.0);
    EXPECT_LT(std::fabs(z_variance), 4.0);
  }
}

TEST(ColumnLevels, LeaveCosmicRaysOut) {
  Image<float, unit::Adu> image = overscan(180.0, 1);
  std::vector<double> clean(kColumns);
  column_levels(image.view(), plato_noise(), clean);
  // Three hits in every fifth column, from just visible to saturated, and one broken pixel.
  for (std::size_t x = 0; x < kColumns; x += 5) {
    image.row(4513)[x] += 40.0F;
    image.row(4520)[x] += 160.0F;
    image.row(4531)[x] = 65535.0F;
  }
  image.row(4511)[7] = std::numeric_limits<float>::quiet_NaN();
  std::vector<double> hit(kColumns);
  column_levels(image.view(), plato_noise(), hit);
  const double rms = std::sqrt(((kReadout * kReadout + 180.0) / (kGain * kGain) + 1.0 / 12.0) / kRows);
  for (std::size_t x = 0; x < kColumns; ++x) EXPECT_NEAR(hit[x], clean[x], 2.0 * rms) << x;  // 27 of 30 values are left
  std::vector<double> struck;
  for (std::size_t x = 0; x < kColumns; x += 5) struck.push_back(hit[x]);
  const Scatter s = scatter_of(struck, kBias + 180.0 / kGain);
  const double z = s.mean / std::sqrt(rms * rms * kRows / (kRows - 3) / static_cast<double>(struck.size()));
  std::printf("columns with hits: z of the mean %+.2f\n", z);
  EXPECT_LT(std::fabs(z), 4.0);
}

TEST(ColumnLevels, OfOneRowAreThatRow) {
  Image<float, unit::Adu> image({3, 10, 3, 1});
  image.row(10)[0] = 1000.0F;
  image.row(10)[1] = 65535.0F;
  image.row(10)[2] = std::numeric_limits<float>::quiet_NaN();
  std::vector<double> levels(3);
  column_levels(image.view(), plato_noise(), levels);
  EXPECT_EQ(levels[0], 1000.0);
  EXPECT_EQ(levels[1], 65535.0);
  EXPECT_TRUE(std::isnan(levels[2]));
}

TEST(ReferenceLevel, IsTheMeanWithoutHits) {
  std::vector<float> values;
  const Image<float, unit::Adu> image = overscan(0.0, 2);
  values.assign(image.pixels().begin(), image.pixels().end());
  const double rms = plato_noise().rms(kBias);
  const double clean = reference_level(values, plato_noise());
  EXPECT_LT(std::fabs(clean - kBias) / rms * std::sqrt(static_cast<double>(values.size())), 4.0);
  for (std::size_t i = 0; i < values.size(); i += 1000) values[i] += 4000.0F;
  // One value in a thousand is left out: the mean moves by sqrt(1/1000) of its own error.
  const double moved = rms / std::sqrt(1000.0 * static_cast<double>(values.size()));
  EXPECT_NEAR(reference_level(values, plato_noise()), clean, 4.0 * moved);
  std::vector<float> none;
  EXPECT_TRUE(std::isnan(reference_level(none, plato_noise())));
}

}  // namespace
}  // namespace astroid
