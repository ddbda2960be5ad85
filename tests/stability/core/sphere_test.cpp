// Hard cases N3, N4 and N5: the sphere's poles, horizon, antipode and wrap, and separations at both ends.
#include "astroid/core/sphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/wcs.hpp"

namespace astroid {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Van der Corput numbers: points that fill [0, 1) evenly, without a generator.
double radical_inverse(unsigned index, unsigned base) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) value += digit * (index % base);
  return value;
}

SkyProjection tan_at(SkyPosition axis) {
  return SkyProjection(
      CameraPointing{.axis = axis, .roll = Degrees(0.0), .scale = PixelScale(15.0), .axis_pixel = {100.0, 200.0}});
}

TEST(StabilityN3, RightAscensionWrapCostsNoAccuracy) {
  const auto point = gnomonic({0.5, 0.0}, {359.5, 0.0});
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->xi, 1.0001015515137, 1e-13);  // tan 1 deg in degrees, as printed in the table
  const double tangent = std::tan(kPi / 180.0) * 180.0 / kPi;
  EXPECT_NEAR(point->xi, tangent, 2.0 * kEpsilon);  // 2 ulp of a number in [1, 2)
  EXPECT_EQ(point->eta, 0.0);
  const auto mirrored = gnomonic({359.5, 0.0}, {0.5, 0.0});
  EXPECT_EQ(mirrored->xi, -point->xi);
}

TEST(StabilityN3, RightAscensionOfThePoleIsArbitrary) {
  const auto a = gnomonic({0.0, 90.0}, {40.0, 60.0});
  for (const double ra : {1.0, 40.0, 123.456, 359.9}) {
    const auto b = gnomonic({ra, 90.0}, {40.0, 60.0});
    EXPECT_NEAR(b->xi, a->xi, 1e-15 * 180.0 / kPi);  // 1e-15 rad
    EXPECT_NEAR(b->eta, a->eta, 1e-15 * 180.0 / kPi);
  }
}

TEST(StabilityN3, HorizonAndAntipodeAreRefused) {
  for (const SkyPosition star :
       {SkyPosition{90.0, 0.0}, {91.0, 0.0}, {180.0, 0.0}, {270.0, 0.0}, {0.0, 90.0}, {0.0, -90.0}}) {
    EXPECT_FALSE(gnomonic(star, {0.0, 0.0})) << star.ra << " " << star.dec;
    EXPECT_FALSE(tan_at({0.0, 0.0}).to_pixel(star)) << star.ra << " " << star.dec;
  }
  EXPECT_TRUE(tan_at({0.0, 0.0}).to_pixel({89.9, 0.0}));
}

TEST(StabilityN3, ProjectionCrossesTheWrapAndThePole) {
  const auto left = tan_at({0.0, 0.0}).to_pixel({359.0, 0.0});
  const auto right = tan_at({0.0, 0.0}).to_pixel({1.0, 0.0});
  ASSERT_TRUE(left && right);
  const double one_degree = std::tan(kPi / 180.0) * 180.0 / kPi * 3600.0 / 15.0;  // px
  EXPECT_NEAR(left->x - 100.0, one_degree, kPixelGrid);
  EXPECT_NEAR(right->x - 100.0, -one_degree, kPixelGrid);
  EXPECT_EQ(left->y, 200.0);
  // One degree across the pole from an axis half a degree on this side of it.
  const auto beyond = tan_at({30.0, 89.5}).to_pixel({210.0, 89.5});
  ASSERT_TRUE(beyond);
  EXPECT_NEAR(beyond->x, 100.0, kPixelGrid);
  EXPECT_NEAR(beyond->y, 200.0 + one_degree, kPixelGrid);
}

TEST(StabilityN3, AxisAtThePoleTakesNorthFromItsRightAscension) {
  // East of the meridian of the axis lies smaller x; the direction of ra = axis lies at smaller y (it was to the
  // south).
  for (const double dec : {90.0, -90.0}) {
    const double away = dec > 0.0 ? 89.0 : -89.0;
    const SkyProjection projection = tan_at({30.0, dec});
    const double one_degree = std::tan(kPi / 180.0) * 180.0 / kPi * 3600.0 / 15.0;
    const auto same = projection.to_pixel({30.0, away});
    const auto east = projection.to_pixel({120.0, away});
    ASSERT_TRUE(same && east);
    EXPECT_NEAR(same->x, 100.0, kPixelGrid);
    EXPECT_NEAR(same->y, 200.0 - (dec > 0.0 ? one_degree : -one_degree), kPixelGrid);
    EXPECT_NEAR(east->x, 100.0 - one_degree, kPixelGrid);
    EXPECT_NEAR(east->y, 200.0, kPixelGrid);
  }
}

// A million points within 89 deg of tangent points all over the sky.
TEST(StabilityN4, InverseGnomonicClosesTheRoundTrip) {
  double worst = 0.0;
  for (unsigned i = 0; i < 1000000; ++i) {
    SkyPosition tangent{360.0 * radical_inverse(i % 97, 2), -90.0 + 180.0 * radical_inverse(i % 89, 3)};
    const double theta = 89.0 * kPi / 180.0 * radical_inverse(i + 1, 2);
    const double angle = 2.0 * kPi * radical_inverse(i + 1, 3);
    const double radius = std::tan(theta) * 180.0 / kPi;
    const TangentPlanePoint point{radius * std::cos(angle), radius * std::sin(angle)};
    const auto back = gnomonic(inverse_gnomonic(point, tangent), tangent);
    ASSERT_TRUE(back);
    const double error = std::hypot(back->xi - point.xi, back->eta - point.eta) * kPi / 180.0;
    worst = std::max(worst, error / (1.0 + std::tan(theta) * std::tan(theta)));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(StabilityN4, OriginReturnsTheTangentPointExactly) {
  for (const SkyPosition tangent :
       {SkyPosition{0.0, 90.0}, {123.4, 90.0}, {77.0, -90.0}, {95.3104, -47.8869}, {359.9, 0.0}}) {
    const SkyPosition back = inverse_gnomonic({0.0, 0.0}, tangent);
    EXPECT_EQ(back.ra, tangent.ra);
    EXPECT_EQ(back.dec, tangent.dec);
    const SkyProjection projection = tan_at(tangent);
    const SkyPosition axis = projection.to_sky({100.0, 200.0});
    EXPECT_EQ(axis.ra, tangent.ra);
    EXPECT_EQ(axis.dec, tangent.dec);
    const auto pixel = projection.to_pixel(tangent);
    ASSERT_TRUE(pixel);
    EXPECT_EQ(pixel->x, 100.0);
    EXPECT_EQ(pixel->y, 200.0);
  }
}

TEST(StabilityN5, TinySeparationsKeepTheirDigits) {
  const double distance = 1e-9;  // rad
  const double degrees = distance * 180.0 / kPi;
  const auto separation = [](SkyPosition a, SkyPosition b) { return to_radians(angular_separation(a, b)).value(); };
  EXPECT_NEAR(separation({0.0, 0.0}, {0.0, degrees}), distance, 1e-7 * distance);
  EXPECT_NEAR(separation({0.0, 0.0}, {degrees, 0.0}), distance, 1e-7 * distance);
  EXPECT_NEAR(separation({360.0 - degrees, 0.0}, {0.0, 0.0}), distance, 1e-4 * distance);  // 360 - d is rounded itself
  EXPECT_NEAR(separation({0.0, 0.0}, {1e-300, 0.0}), 1e-300 * kPi / 180.0, 1e-315);
  EXPECT_EQ(separation({10.0, 20.0}, {10.0, 20.0}), 0.0);
}

TEST(StabilityN5, AntipodesAreHalfATurnApart) {
  const auto separation = [](SkyPosition a, SkyPosition b) { return to_radians(angular_separation(a, b)).value(); };
  EXPECT_NEAR(separation({0.0, 0.0}, {180.0, 0.0}), kPi, 1e-15);
  EXPECT_NEAR(separation({10.0, 90.0}, {77.0, -90.0}), kPi, 1e-15);
  EXPECT_NEAR(separation({33.0, 41.5}, {213.0, -41.5}), kPi, 1e-15);
  const double short_of = 1e-9;  // rad
  EXPECT_NEAR(kPi - separation({0.0, 0.0}, {180.0, short_of * 180.0 / kPi}), short_of, 1e-15);
}

}  // namespace
}  // namespace astroid
