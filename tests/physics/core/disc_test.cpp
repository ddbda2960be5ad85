#include "astroid/core/disc.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/units.hpp"

namespace astroid {
namespace {

TEST(Disc, CoversItsArea) {
  for (const double radius : {0.05, 0.3, 0.5, 0.7071, 1.0, 3.7, 50.0, 300.0}) {
    for (const PixelPosition centre : {PixelPosition{0.0, 0.0}, {0.5, 0.5}, {0.31, -0.27}, {-0.5, 0.123}}) {
      const int reach = static_cast<int>(radius) + 2;
      double area = 0.0;
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
          const double covered = disc_coverage(centre, radius, x, y);
          EXPECT_GE(covered, 0.0);
          EXPECT_LE(covered, 1.0);
          area += covered;
        }
      EXPECT_NEAR(area / (kPi * radius * radius), 1.0, 1e-11) << radius;
    }
  }
}

TEST(Disc, HasTheCoverageOfSimpleCases) {
  EXPECT_NEAR(disc_coverage({0.0, 0.0}, 0.5, 0, 0), kPi / 4.0, 1e-15);
  EXPECT_NEAR(disc_coverage({0.5, 0.5}, 1.0, 1, 1), kPi / 4.0, 1e-15);  // a quarter of the unit disc
  EXPECT_NEAR(disc_coverage({0.5, 0.0}, 0.25, 0, 0), kPi / 32.0, 1e-15);
  EXPECT_EQ(disc_coverage({0.0, 0.0}, 10.0, 3, -2), 1.0);
  EXPECT_EQ(disc_coverage({0.0, 0.0}, 10.0, 13, 0), 0.0);
  EXPECT_EQ(disc_coverage({0.0, 0.0}, 0.0, 0, 0), 0.0);
  EXPECT_EQ(disc_coverage({std::nan(""), 0.0}, std::nan(""), 0, 0), 0.0);
}

TEST(Disc, ChangesContinuouslyAsItMoves) {
  double last = disc_coverage({-3.0, 0.2}, 2.3, 0, 0);
  for (int i = 1; i <= 60000; ++i) {
    const double now = disc_coverage({-3.0 + 1e-4 * i, 0.2}, 2.3, 0, 0);
    ASSERT_LT(std::abs(now - last), 1.5e-4);
    last = now;
  }
}

}  // namespace
}  // namespace astroid
