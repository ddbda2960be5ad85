#include "astroid/photometry/aperture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {
namespace {

double total_overlap(PixelPosition centre, double radius) {
  const Rectangle box = aperture_box(centre, radius);
  std::vector<double> overlap(box.size());
  aperture_overlap(centre, radius, box, overlap);
  return std::accumulate(overlap.begin(), overlap.end(), 0.0);
}

TEST(Aperture, HasTheAreaOfACircleForAnyRadiusAndCentre) {
  for (const double radius : {1e-6, 0.1, 0.3, 0.5, 0.70711, 1.0, 1.5852, 3.0, 10.7, 101.3}) {
    for (const PixelPosition centre :
         {PixelPosition{0.0, 0.0}, {0.5, 0.5}, {0.5, 0.0}, {0.37, -0.81}, {-1234.123, 4510.499}, {0.5 - 1e-9, 0.0}}) {
      const double area = kPi * radius * radius;
      // The pixel edges are known to 1e-12 px at 4510 px from the origin, which shifts the arc by as much.
      EXPECT_NEAR(total_overlap(centre, radius), area, 2e-15 * area + 4e-12 * radius)
          << radius << " at " << centre.x << ", " << centre.y;
    }
  }
}

TEST(Aperture, SharesAPixelInClosedForm) {
  EXPECT_DOUBLE_EQ(disc_rectangle_overlap(0.3, -0.5, 0.5, -0.5, 0.5), kPi * 0.09);
  EXPECT_DOUBLE_EQ(disc_rectangle_overlap(0.3, 0.0, 1.0, -0.5, 0.5), kPi * 0.045);
  EXPECT_DOUBLE_EQ(disc_rectangle_overlap(0.3, 0.0, 1.0, 0.0, 1.0), kPi * 0.0225);
  EXPECT_DOUBLE_EQ(disc_rectangle_overlap(1.0, 0.0, 1.0, 0.0, 1.0), kPi / 4.0);
  // A unit disc around a unit square's mid-edge: ∫ √(1-x²) over |x| <= 1/2, i.e. √3/4 + π/6.
  EXPECT_DOUBLE_EQ(disc_rectangle_overlap(1.0, -0.5, 0.5, 0.0, 1.0), std::sqrt(3.0) / 4.0 + kPi / 6.0);
  EXPECT_EQ(disc_rectangle_overlap(3.0, -0.5, 0.5, -0.5, 0.5), 1.0);
  EXPECT_EQ(disc_rectangle_overlap(3.0, 3.0, 4.0, -0.5, 0.5), 0.0);
  EXPECT_EQ(disc_rectangle_overlap(0.0, -0.5, 0.5, -0.5, 0.5), 0.0);
}

TEST(Aperture, KeepsItsAccuracyWhereTheArcIsNearlyStraight) {
  // Across a pixel the edge of a disc of radius 1e4 px bulges by 1/(8·1e4) px; the mean bulge is two thirds of it plus
  // terms of 1e-13.
  const double radius = 1e4;
  const double overlap = disc_rectangle_overlap(radius, radius - 0.5, radius + 0.5, -0.5, 0.5);
  EXPECT_NEAR(overlap, 0.5 - 1.0 / (24.0 * radius), 2e-11);
}

TEST(Aperture, IsTheSameInEveryMirrorImage) {
  for (const double x : {0.2, 1.3, 2.7}) {
    for (const double y : {0.1, 0.9, 2.2}) {
      const double value = disc_rectangle_overlap(2.5, x, x + 1.0, y, y + 1.0);
      EXPECT_EQ(value, disc_rectangle_overlap(2.5, -x - 1.0, -x, y, y + 1.0));
      EXPECT_EQ(value, disc_rectangle_overlap(2.5, x, x + 1.0, -y - 1.0, -y));
      EXPECT_NEAR(value, disc_rectangle_overlap(2.5, y, y + 1.0, x, x + 1.0), 2e-15);
    }
  }
}

TEST(Aperture, GrowsWithItsRadiusInEveryPixel) {
  double last = 0.0;
  for (int i = 0; i <= 4000; ++i) {
    const double overlap = disc_rectangle_overlap(1e-3 * i, 1.2, 2.2, 0.4, 1.4);
    EXPECT_GE(overlap, last - 1e-15);
    last = overlap;
  }
  EXPECT_EQ(last, 1.0);
}

TEST(Aperture, WithoutUsableGeometryTouchesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(aperture_box({nan, 1.0}, 3.0).empty());
  EXPECT_TRUE(aperture_box({1.0, infinity}, 3.0).empty());
  EXPECT_TRUE(aperture_box({1.0, 1.0}, nan).empty());
  EXPECT_TRUE(aperture_box({1.0, 1.0}, 0.0).empty());
  EXPECT_TRUE(aperture_box({1.0, 1e300}, 3.0).empty());
}

}  // namespace
}  // namespace astroid
