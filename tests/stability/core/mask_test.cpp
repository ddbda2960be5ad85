// Hard cases N37 and N39: ties, zero flux, not-a-number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "astroid/core/noise.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::size_t> mask_of(double electrons, double sigma, PixelPosition at, Rectangle window) {
  std::vector<double> target(window.size());
  make_gaussian_psf(sigma)->integrate(at, window, target);
  for (double& e : target) e *= electrons;
  return optimal_binary_mask(target, target, {.background = 945.0, .readout = 50.2, .quantisation = 7.2});
}

TEST(OptimalMask, OfASymmetricStarIsASymmetricSet) {
  const std::set<std::size_t> centred = {1, 5, 9, 13, 21};  // rings around a pixel
  const std::set<std::size_t> corner = {4, 12, 16, 24};
  std::set<std::size_t> seen;
  for (const double sigma : {0.5, 0.6, 0.8, 1.0}) {
    for (double electrons = 300.0; electrons < 3e6; electrons *= 1.7) {
      const std::size_t n = mask_of(electrons, sigma, {3.0, 3.0}, {0, 0, 7, 7}).size();
      const std::size_t m = mask_of(electrons, sigma, {2.5, 2.5}, {0, 0, 6, 6}).size();
      if (n <= 21) {
        EXPECT_TRUE(centred.contains(n)) << n << " px at " << electrons << " e-, sigma " << sigma;
      }
      if (m <= 24) {
        EXPECT_TRUE(corner.contains(m)) << m << " px at " << electrons << " e-, sigma " << sigma;
      }
      seen.insert({n, m});
    }
  }
  EXPECT_GE(seen.size(), 6U);  // the sweep does reach different masks
}

TEST(OptimalMask, DoesNotDependOnTheLastBits) {
  std::vector<double> target = {10.0, 50.0, 10.0, 50.0, 100.0, 50.0, 10.0, 50.0, 10.0};
  const PixelNoise noise{.background = 700.0};
  auto whole = optimal_binary_mask(target, target, noise);
  target[3] = std::nextafter(50.0, 60.0);
  target[5] = std::nextafter(50.0, 40.0);
  auto shaken = optimal_binary_mask(target, target, noise);
  EXPECT_EQ(whole, shaken);
  EXPECT_EQ(whole.size(), 5U);
}

TEST(OptimalMask, LeavesOutPixelsWithoutTargetFlux) {
  const std::vector<double> target = {0.0, 100.0, 0.0, kNan};
  const std::vector<double> total = {5.0, 100.0, 0.0, 3.0};
  const MaskGrowth growth = grow_mask(target, total, {});
  EXPECT_EQ(growth.order, std::vector<std::size_t>{1});
  for (const double nsr : growth.nsr) EXPECT_FALSE(std::isnan(nsr));
  EXPECT_EQ(optimal_binary_mask(target, total, {}), std::vector<std::size_t>{1});
}

TEST(OptimalMask, OfNoStarIsEmptyAndItsNoiseInfinite) {
  const std::vector<double> nothing(4, 0.0);
  EXPECT_TRUE(optimal_binary_mask(nothing, nothing, {}).empty());
  EXPECT_TRUE(optimal_binary_mask({}, {}, {}).empty());
  EXPECT_EQ(nsr_exposure(nothing, nothing, std::vector<double>(4, 1.0), {}), kInfinity);
  EXPECT_EQ(nsr_of_mask(nothing, nothing, {}, {}), kInfinity);
  EXPECT_EQ(optimal_weights(nothing, nothing, {}), nothing);
}

TEST(OptimalMask, OfOnePixelIsThatPixel) {
  const std::vector<double> one = {7.0};
  EXPECT_EQ(optimal_binary_mask(one, one, {.readout = 50.0}), std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace astroid
