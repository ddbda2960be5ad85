// Distortion and its inverse where naive inverses fail (N6).
#include "astroid/core/distortion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/test/plato_distortion.hpp"

namespace astroid {
namespace {

double distance(PixelShift a, PixelShift b) {
  return std::hypot(a.dx - b.dx, a.dy - b.dy);
}

// Where a perfect camera has light from `angle` deg off axis.
PixelShift at(double angle, double azimuth) {
  const double r = test::plato_focal_length().value() * std::tan(angle * kPi / 180.0);
  return {r * std::cos(azimuth), r * std::sin(azimuth)};
}

std::shared_ptr<const Distortion> plato() {
  return make_radial_distortion(test::plato_distortion(), test::plato_focal_length());
}

TEST(Distortion, ReturnsWhereItCameFrom) {
  const auto distortion = plato();
  double worst = 0.0;
  double largest = 0.0;
  for (int k = 0; k <= 200; ++k) {
    for (int a = 0; a < 36; ++a) {
      const PixelShift ideal = at(test::kPlatoFieldRadius * k / 200.0, a * kPi / 18.0 + 0.01);
      const auto real = distortion->distort(ideal);
      ASSERT_TRUE(real);
      const auto back = distortion->undistort(*real);
      ASSERT_TRUE(back);
      worst = std::max(worst, distance(*back, ideal));
      largest = std::max(largest, distance(*real, ideal));
    }
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(largest, 184.0, 3.0);
  RecordProperty("worst_round_trip_px", std::to_string(worst));
}

TEST(Distortion, HasNoResidualWhereFixedPointIterationIsStillFar) {
  // Errors after 1, 2, 4, 8 and 16 fixed-point steps at the edge of the field, computed independently: 23.4, 2.81,
  // 4.1e-2, 8.8e-6, 9e-13 px; each step leaves 0.12 of the last.
  const auto distortion = plato();
  const PixelShift ideal = at(test::kPlatoFieldRadius, 0.0);
  const PixelShift real = *distortion->distort(ideal);
  PixelShift guess = real;
  std::vector<double> errors;
  for (int step = 1; step <= 16; ++step) {
    const PixelShift image = *distortion->distort(guess);
    guess = {guess.dx - (image.dx - real.dx), guess.dy - (image.dy - real.dy)};
    errors.push_back(distance(guess, ideal));
  }
  EXPECT_NEAR(errors[0], 23.4, 0.5);
  EXPECT_NEAR(errors[1], 2.81, 0.1);
  EXPECT_NEAR(errors[3], 4.1e-2, 2e-3);
  EXPECT_NEAR(errors[7], 8.8e-6, 1e-6);
  EXPECT_LT(distance(*distortion->undistort(real), ideal), 1e-11);
}

TEST(Distortion, IsBetterThanAFittedInverse) {
  // PlatoSim's own inverse coefficients leave up to 0.086 px (at 12 deg).
  const auto distortion = plato();
  const auto fitted = make_radial_distortion({.k1 = -0.323487,
                                              .k2 = 0.268344,
                                              .k3 = -0.435473,
                                              .p1 = 0.5 * -0.000827654,
                                              .p2 = 0.5 * -0.000321713,
                                              .s1 = -0.00019304 + 0.5 * 0.000321713,
                                              .s2 = -0.000176961 + 0.5 * 0.000827654},
                                             test::plato_focal_length());
  double worst = 0.0;
  double worst_of_ours = 0.0;
  for (int k = 0; k <= 189; ++k) {
    for (int a = 0; a < 36; ++a) {
      const PixelShift ideal = at(0.1 * k, a * kPi / 18.0);
      const PixelShift real = *distortion->distort(ideal);
      worst = std::max(worst, distance(*fitted->distort(real), ideal));
      worst_of_ours = std::max(worst_of_ours, distance(*distortion->undistort(real), ideal));
    }
  }
  EXPECT_NEAR(worst, 0.086, 0.02);
  EXPECT_LT(worst_of_ours, 1e-9);
}

TEST(Distortion, IsRefusedBeyondItsFold) {
  // x - x³ turns back at x = 1/sqrt(3); beyond x = 1 the image is turned by half a circle, with a positive determinant.
  constexpr double kFocal = 1000.0;
  const auto folding = make_radial_distortion({.k1 = -1.0}, Pixels(kFocal));
  const double fold = kFocal / std::sqrt(3.0);
  EXPECT_TRUE(folding->distort({0.999 * fold, 0.0}));
  for (const double x : {1.001 * fold, 600.0, 900.0, 1001.0, 1500.0, 1e5}) {
    EXPECT_FALSE(folding->distort({x, 0.0})) << x;
    EXPECT_FALSE(folding->distort({0.6 * x, -0.8 * x})) << x;
  }
  // Nothing falls farther out than the fold's image, 2/(3 sqrt 3).
  const double edge = kFocal * 2.0 / (3.0 * std::sqrt(3.0));
  EXPECT_FALSE(folding->undistort({1.0001 * edge, 0.0}));
  EXPECT_FALSE(folding->undistort({10.0 * edge, 0.0}));
  for (const double part : {0.1, 0.5, 0.9, 0.99, 0.9999, 0.999999}) {
    const auto ideal = folding->undistort({0.0, part * edge});
    ASSERT_TRUE(ideal) << part;
    EXPECT_LT(ideal->dy, fold);
    EXPECT_NEAR(folding->distort(*ideal)->dy, part * edge, 1e-9);
  }
}

TEST(Distortion, OfAFoldingSipPolynomialIsRefusedToo) {
  SipPolynomial sip(3);
  sip.a[sip.index(3, 0)] = -1e-6;
  sip.b[sip.index(0, 3)] = -1e-6;  // u - u³ / 10⁶ folds at 577.35 px
  const auto distortion = make_sip_distortion(sip);
  EXPECT_TRUE(distortion->undistort({577.0, -577.0}));
  EXPECT_FALSE(distortion->undistort({578.0, 0.0}));
  EXPECT_FALSE(distortion->undistort({1200.0, 1200.0}));
  EXPECT_FALSE(distortion->distort({385.0, 0.0}));  // 2/(3 sqrt 3) 1000 = 384.9
  const auto real = distortion->distort({380.0, -380.0});
  ASSERT_TRUE(real);
  EXPECT_NEAR(distortion->undistort(*real)->dx, 380.0, 1e-10);
  EXPECT_NEAR(distortion->undistort(*real)->dy, -380.0, 1e-10);
}

TEST(Distortion, OfAStrongSipPolynomialReturnsWhereItCameFrom) {
  SipPolynomial sip(5);
  for (int i = 0; i <= sip.order; ++i) {
    for (int j = 0; i + j <= sip.order; ++j) {
      if (i + j < 2) continue;
      const double size = 60.0 / std::pow(2000.0, i + j);  // 60 px a term at 2000 px
      sip.a[sip.index(i, j)] = size * std::cos(3.0 * i + 5.0 * j);
      sip.b[sip.index(i, j)] = size * std::sin(2.0 * i + 7.0 * j);
    }
  }
  const auto distortion = make_sip_distortion(sip);
  for (int y = -2000; y <= 2000; y += 250) {
    for (int x = -2000; x <= 2000; x += 250) {
      const PixelShift real{x + 0.3, y - 0.4};
      const auto ideal = distortion->undistort(real);
      ASSERT_TRUE(ideal);
      const auto back = distortion->distort(*ideal);
      ASSERT_TRUE(back);
      EXPECT_LT(distance(*back, real), 1e-9);
    }
  }
}

TEST(Distortion, OfNothingIsNothing) {
  const auto none = make_radial_distortion({}, Pixels(13751.0));
  for (const PixelShift p : {PixelShift{0.0, 0.0}, {123.456, -7.0}, {1e-300, 1e5}}) {
    EXPECT_NEAR(none->distort(p)->dx, p.dx, 1e-15 * std::abs(p.dx));
    EXPECT_NEAR(none->undistort(p)->dy, p.dy, 1e-15 * std::abs(p.dy));
  }
  const auto distortion = plato();
  EXPECT_EQ(distortion->distort({0.0, 0.0})->dx, 0.0);
  EXPECT_EQ(distortion->undistort({0.0, 0.0})->dy, 0.0);
}

TEST(Distortion, HasNoPlaceForWhatIsNotANumber) {
  const auto distortion = plato();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double bad : {kNan, kInfinite, -kInfinite}) {
    EXPECT_FALSE(distortion->distort({bad, 0.0}));
    EXPECT_FALSE(distortion->undistort({0.0, bad}));
  }
  EXPECT_FALSE(distortion->distort({1e200, 1.0}));  // overflows
}

TEST(Distortion, RefusesUnusableCoefficients) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(make_radial_distortion({.k2 = kNan}, Pixels(1.0))), InputError);
  EXPECT_THROW(static_cast<void>(make_radial_distortion({}, Pixels(0.0))), InputError);
  EXPECT_THROW(static_cast<void>(make_sip_distortion(SipPolynomial(1))), InputError);
  EXPECT_THROW(static_cast<void>(make_sip_distortion(SipPolynomial(10))), InputError);
  SipPolynomial sip(2);
  sip.b[sip.index(1, 1)] = kNan;
  EXPECT_THROW(static_cast<void>(make_sip_distortion(sip)), InputError);
}

TEST(SipFit, StandsForPlatosDistortionInAHeader) {
  // A quarter of the focal plane, the axis just outside its corner.
  const auto distortion = plato();
  const auto fit = fit_sip(*distortion, {0, 0, 4510, 4510}, {-82.5, -82.5}, 1e-5);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->worst, 1e-3);
  const auto sip = make_sip_distortion(fit->polynomial);
  for (int k = 0; k <= 100; ++k) {
    const PixelShift real{45.0 * k + 83.3, 4592.0 - 45.1 * k};
    EXPECT_LE(distance(*sip->undistort(real), *distortion->undistort(real)), 1.5 * fit->worst);
  }
}

}  // namespace
}  // namespace astroid
