#include "astroid/core/psf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace astroid {
namespace {

TEST(StampBox, HoldsEveryPixelThatTheSquareTouches) {
  EXPECT_EQ(stamp_box({10.0, 20.0}, 2.0), (Rectangle{8, 18, 5, 5}));
  EXPECT_EQ(stamp_box({10.4, 20.0}, 2.0), (Rectangle{8, 18, 5, 5}));
  EXPECT_EQ(stamp_box({10.6, -3.2}, 1.0), (Rectangle{10, -4, 3, 3}));
}

TEST(StampBox, OfAPointOnAnEdgeHoldsBothPixels) {
  EXPECT_EQ(stamp_box({1.5, 1.0}, 0.0), (Rectangle{1, 1, 2, 1}));
}

TEST(StampBox, IsEmptyWithoutAPosition) {
  EXPECT_TRUE(stamp_box({std::numeric_limits<double>::quiet_NaN(), 0.0}, 3.0).empty());
  EXPECT_TRUE(stamp_box({1e300, 0.0}, 3.0).empty());
  EXPECT_TRUE(stamp_box({0.0, 0.0}, std::numeric_limits<double>::infinity()).empty());
}

TEST(GaussianPsf, RefusesAWidthThatIsNoWidth) {
  for (const double sigma : {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(static_cast<void>(make_gaussian_psf(sigma)), InputError) << sigma;
  }
}

TEST(GaussianPsf, MarksPixelsOfAStarWithoutAPosition) {
  std::vector<double> p(9);
  make_gaussian_psf(0.6)->integrate({0.0, std::numeric_limits<double>::quiet_NaN()}, {0, 0, 3, 3}, p);
  for (const double value : p) EXPECT_TRUE(std::isnan(value));
}

TEST(GaussianPsf, RefusesABufferOfTheWrongSize) {
  std::vector<double> p(8);
  EXPECT_THROW(make_gaussian_psf(0.6)->integrate({0.0, 0.0}, {0, 0, 3, 3}, p), BugError);
}

TEST(GaussianPsf, SaysWhatItIs) {
  EXPECT_EQ(make_gaussian_psf(0.6)->description(), "Gaussian of sigma 0.6 px, integrated over pixels exactly");
  EXPECT_EQ(make_gaussian_psf(0.6)->approximation_error(), 0.0);
}

}  // namespace
}  // namespace astroid
