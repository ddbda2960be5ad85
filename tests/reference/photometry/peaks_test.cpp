// Peaks by basins and saddles against a water level that is lowered pixel by pixel; the filter against plain sums.
#include "detect/peaks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "astroid/test/star_field.hpp"

namespace astroid {
namespace {

test::StarField field_of(int nx, int ny, int stars, std::uint64_t seed) {
  test::StarFieldSettings settings;
  settings.nx = nx;
  settings.ny = ny;
  settings.stars = stars;
  settings.seed = seed;
  return test::make_star_field(settings);
}

TEST(FindPeaks, AreThoseOfALoweredWaterLevel) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const test::StarField field = field_of(256, 200, 700, seed);
    const BackgroundMap map(field.frame, 0, {});
    const detail::SmoothImage image(field.frame, map, detail::gaussian_kernel(2.5));
    for (const double prominence : {0.0, 2.0, 5.0}) {
      const detail::PeakSettings settings{5.0, 1.5, prominence, 0.005, 0.02};
      const auto fast = detail::find_peaks(image, settings);
      const auto plain = detail::reference_peaks(image, settings);
      const auto key = [](const detail::FilteredPeak& p) { return std::pair{p.y, p.x}; };
      std::size_t common = 0;
      for (const auto& p : fast)
        common += std::any_of(plain.begin(), plain.end(), [&](const auto& q) { return key(p) == key(q); }) ? 1 : 0;
      std::cout << fast.size() << " peaks, " << common << " of " << plain.size() << " in common\n";
      ASSERT_GT(plain.size(), 100U);
      // A peak that does not stand out joins the star that it touches, and takes its place if it is higher; which one
      // it touches depends on the way downhill.
      EXPECT_EQ(fast.size(), plain.size());
      EXPECT_GE(static_cast<double>(common), 0.99 * static_cast<double>(plain.size()));
    }
  }
}

TEST(SmoothImage, IsThePlainSumOverTheKernel) {
  test::StarField field = field_of(61, 47, 20, 3);
  field.frame.flags.view(0).at(30, 20) = pixel_flag::kBad;
  MeshSettings mesh;
  mesh.cell = 16;
  const BackgroundMap map(field.frame, 0, mesh);
  const detail::FilterKernel kernel = detail::gaussian_kernel(2.5);
  const detail::SmoothImage image(field.frame, map, kernel);
  const int half = static_cast<int>(kernel.row.size() / 2);
  std::vector<std::vector<double>> level(47, std::vector<double>(61));
  for (int y = 0; y < 47; ++y) map.level_row(y, level[static_cast<std::size_t>(y)]);
  std::vector<double> rms(61);
  for (int y = 0; y < 47; ++y) {
    map.rms_row(y, rms);
    for (int x = 0; x < 61; ++x) {
      double sum = 0.0;
      for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
          if (x + i < 0 || x + i >= 61 || y + j < 0 || y + j >= 47) continue;
          if (field.frame.flags.view(0).at(x + i, y + j) != 0) continue;
          const auto row = static_cast<std::size_t>(y + j);
          const auto column = static_cast<std::size_t>(x + i);
          sum += static_cast<double>(kernel.column[static_cast<std::size_t>(j + half)]) *
                 static_cast<double>(kernel.row[static_cast<std::size_t>(i + half)]) *
                 (static_cast<double>(field.frame.pixels.view(0).at(x + i, y + j)) - level[row][column]);
        }
      }
      const double expected = sum / (rms[static_cast<std::size_t>(x)] * kernel.norm());
      // The noise is looked up every eighth row; in cells of 16 px it changes by a few per cent over them.
      EXPECT_NEAR(static_cast<double>(image.at(x, y)), expected, 1e-3 + 0.05 * std::abs(expected)) << x << ", " << y;
    }
  }
}

TEST(FindPeaks, OfAPlateauIsOne) {
  test::StarField field = field_of(32, 32, 0, 1);
  for (int y = 10; y < 15; ++y)
    for (int x = 10; x < 15; ++x) field.frame.pixels.view(0).at(x, y) = 65535.0F;
  const BackgroundMap map(field.frame, 0, {});
  const detail::SmoothImage image(field.frame, map, detail::gaussian_kernel(0.5));
  EXPECT_EQ(detail::find_peaks(image, {}).size(), 1U);
}

}  // namespace
}  // namespace astroid
