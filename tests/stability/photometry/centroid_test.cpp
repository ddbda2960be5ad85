// Hard cases N18 and N19: centroids of nothing, of one pixel, of light of both signs, of saturated stars.
#include "astroid/photometry/centroid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

GroupPixels constant(Rectangle box, double value) {
  GroupPixels pixels;
  pixels.box = box;
  pixels.electrons.assign(box.size(), value);
  pixels.variance.assign(box.size(), 25.0);
  pixels.usable.assign(box.size(), 1);
  return pixels;
}

GroupPixels star_at(PixelPosition place, double flux, int side = 15) {
  GroupPixels pixels = constant({0, 0, side, side}, 0.0);
  std::vector<double> stamp(pixels.box.size());
  make_gaussian_psf(1.1)->integrate(place, pixels.box, stamp);
  for (std::size_t k = 0; k < stamp.size(); ++k) pixels.electrons[k] = flux * stamp[k];
  return pixels;
}

TEST(Centroid, OfNothingIsNowhereAndSaysSo) {
  for (const double value : {0.0, -0.0, -3.0, -1e300}) {
    const Centroid c = centroid_of(constant({3, 4, 7, 5}, value));
    EXPECT_TRUE(std::isnan(c.position.x));
    EXPECT_TRUE(std::isnan(c.position.y));
    EXPECT_EQ(c.flags, measurement_flag::kNoFlux);
  }
  EXPECT_EQ(centroid_of(constant({0, 0, 4, 4}, kNan)).flags, measurement_flag::kNoFlux | measurement_flag::kBadPixel);
  EXPECT_EQ(centroid_of(GroupPixels{}).flags, measurement_flag::kNoFlux);
  EXPECT_EQ(centroid_of(constant({0, 0, 2, 2}, 1e308)).flags, measurement_flag::kNoFlux);  // its sum is no number
}

TEST(Centroid, OfAConstantImageIsItsMiddleExactly) {
  for (const double value : {0.1, 1.0, 1e-300, 3e5, 1.0 / 3.0})
    for (const Rectangle& box : {Rectangle{0, 0, 5, 5}, Rectangle{-3, 17, 6, 9}, Rectangle{2, 2, 1, 8}}) {
      const Centroid c = centroid_of(constant(box, value));
      EXPECT_EQ(c.position.x, box.x0 + 0.5 * (box.nx - 1));
      EXPECT_EQ(c.position.y, box.y0 + 0.5 * (box.ny - 1));
      EXPECT_EQ(c.flags, 0U);
    }
}

TEST(Centroid, OfOnePixelIsThatPixelWithoutAnError) {
  const Centroid c = centroid_of(constant({7, 9, 1, 1}, 12.0));
  EXPECT_EQ(c.position.x, 7.0);
  EXPECT_EQ(c.position.y, 9.0);
  EXPECT_TRUE(std::isnan(c.covariance[0]));
  EXPECT_EQ(c.flags, 0U);
  // The same by weights.
  std::vector<double> weight(25, 0.0);
  weight[5 * 3 + 1] = 1.0;
  const Centroid masked = centroid_of(constant({0, 0, 5, 5}, 12.0), weight);
  EXPECT_EQ(masked.position.x, 1.0);
  EXPECT_EQ(masked.position.y, 3.0);
  EXPECT_TRUE(std::isnan(masked.covariance[2]));
}

TEST(Centroid, BeyondThePixelsIsNone) {
  GroupPixels pixels = constant({0, 0, 5, 1}, 0.0);
  pixels.electrons = {-10.0, 0.0, 0.0, 0.0, 11.0};  // the moment is at 44 px
  const Centroid c = centroid_of(pixels);
  EXPECT_TRUE(std::isnan(c.position.x));
  EXPECT_EQ(c.flags, measurement_flag::kNoFlux);
}

TEST(Centroid, HasTheScatterItStates) {
  const GroupPixels clean = star_at({7.3, 6.6}, 8000.0);
  double squares = 0.0;
  double stated = 0.0;
  constexpr std::uint32_t kRealisations = 2000;
  for (std::uint32_t r = 0; r < kRealisations; ++r) {
    const RandomStream noise = make_stream(r, StreamId{5}, 0, 0);
    GroupPixels pixels = clean;
    for (std::size_t k = 0; k < pixels.electrons.size(); ++k)
      pixels.electrons[k] = poisson_at_step(noise, StepAddress{.step = 2 * k}, clean.electrons[k]) +
                            5.0 * normal_at_step(noise, StepAddress{.step = 2 * k + 1});
    const Centroid c = centroid_of(pixels);
    squares += (c.position.x - 7.3) * (c.position.x - 7.3);
    stated += c.covariance[0];
  }
  // max(0, electrons) of pixels without light adds the mean of half a normal distribution, 2 e-² to 25.
  EXPECT_NEAR(std::sqrt(squares / stated), 1.0, 0.04 + 3.0 / std::sqrt(2.0 * kRealisations));
}

TEST(Centroid, OfASymmetricBloomIsInTheRowWhereTheStarIs) {  // N19
  GroupPixels pixels = star_at({7.0, 7.0}, 1e6);
  constexpr double kFullWell = 3e4;
  // Excess charge goes both ways along its column.
  for (int x = 0; x < 15; ++x) {
    double excess = 0.0;
    for (int y = 0; y < 15; ++y) {
      double& e = pixels.electrons[static_cast<std::size_t>(15 * y + x)];
      if (e > kFullWell) {
        excess += e - kFullWell;
        e = kFullWell;
      }
    }
    for (int d = 1; d < 8 && excess > 0.0; ++d)
      for (const int y : {7 - d, 7 + d}) {
        double& e = pixels.electrons[static_cast<std::size_t>(15 * y + x)];
        const double room = std::min(std::max(0.0, kFullWell - e), 0.5 * excess);
        e += room;
        excess -= room;
      }
  }
  EXPECT_NEAR(centroid_of(pixels).position.x, 7.0, 1e-9);
}

TEST(Centroid, OfAStarThatBledToOneSideIsBiasedTheMoreTheMoreItBled) {  // N19
  // Light that is only clipped has a centroid that wanders by a hundredth of a pixel; charge that bled moves it for
  // good.
  constexpr double kFullWell = 3e4;
  double last = 0.0;
  for (const double flux : {3e5, 5e5, 8e5, 1.2e6}) {
    GroupPixels pixels = star_at({7.2, 5.0}, flux, 21);
    for (int x = 0; x < 21; ++x) {
      double carried = 0.0;
      for (int y = 0; y < 21; ++y) {
        double& e = pixels.electrons[static_cast<std::size_t>(21 * y + x)];
        e += carried;
        carried = std::max(0.0, e - kFullWell);
        e -= carried;
      }
    }
    const Centroid c = centroid_of(pixels);
    EXPECT_GT(c.position.y - 5.0, last) << flux;
    last = c.position.y - 5.0;
  }
  EXPECT_GT(last, 0.5);
}

TEST(Centroid, SaysWhenPixelsWereLeftOut) {
  GroupPixels pixels = star_at({7.0, 7.0}, 1e4);
  pixels.usable[7 * 15 + 8] = 0;
  EXPECT_EQ(centroid_of(pixels).flags, measurement_flag::kBadPixel);
  pixels.usable[7 * 15 + 8] = 1;
  pixels.electrons[3] = kNan;
  EXPECT_EQ(centroid_of(pixels).flags, measurement_flag::kBadPixel);
}

}  // namespace
}  // namespace astroid
