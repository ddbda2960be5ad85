// Hard cases N16, N37 and N38: fluxes that are not positive, magnitudes at the ends of the range.
#include "astroid/core/photometric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"

namespace astroid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double ulps(double value, long double exact) {
  const auto nearest = static_cast<double>(exact);
  const double ulp = std::nextafter(nearest, kInfinity) - nearest;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / static_cast<long double>(ulp));
}

TEST(FluxRatio, IsExactToFourUlp) {
  double worst = 0.0;
  for (int i = -30000; i <= 40000; ++i) {
    const double m = i * 0.00100000234;
    const double zp = 20.62;
    const long double exact = std::pow(10.0L, -0.4L * (static_cast<long double>(m) - static_cast<long double>(zp)));
    worst = std::max(worst, ulps(electron_rate(Magnitude(m), Magnitude(zp)).value(), exact));
    const long double plain = std::pow(10.0L, -0.4L * static_cast<long double>(m));
    worst = std::max(worst, ulps(flux_ratio(DeltaMag(m)), plain));
  }
  EXPECT_LE(worst, 4.0);
  EXPECT_GT(worst, 0.0);
  for (const double d : {-120.0, -99.99, 99.99, 120.0}) {
    EXPECT_LE(ulps(flux_ratio(DeltaMag(d)), std::pow(10.0L, -0.4L * static_cast<long double>(d))), 4.0);
  }
}

TEST(ElectronRate, OfACatalogueBlankIsNothing) {
  EXPECT_LT(electron_rate(Magnitude(99.0), Magnitude(20.62)).value(), 1e-30);
  EXPECT_EQ(electron_rate(Magnitude(kInfinity), Magnitude(20.62)).value(), 0.0);
}

TEST(ElectronRate, RefusesWhatIsNoMagnitude) {
  for (const double m : {kNan, -kInfinity, -1000.0}) {
    EXPECT_THROW(static_cast<void>(electron_rate(Magnitude(m), Magnitude(20.62))), InputError) << m;
  }
  EXPECT_THROW(static_cast<void>(zero_point({})), InputError);
}

TEST(MagnitudeOf, HasNoValueForAFluxThatIsNotPositive) {
  for (const double rate : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_FALSE(magnitude_of(ElectronsPerSecond(rate), Magnitude(20.62)).has_value()) << rate;
  }
}

struct Softening {
  double b, at_zero, at_ten;
};

TEST(AsinhMagnitude, ReproducesTheSurveysTable) {
  for (const Softening& row :
       {Softening{1.4e-10, 24.63, 22.12}, Softening{0.9e-10, 25.11, 22.60}, Softening{1.2e-10, 24.80, 22.29},
        Softening{1.8e-10, 24.36, 21.85}, Softening{7.4e-10, 22.83, 20.32}}) {
    EXPECT_NEAR(asinh_magnitude(0.0, row.b).value(), row.at_zero, 6e-3);
    EXPECT_NEAR(asinh_magnitude(10.0 * row.b, row.b).value(), row.at_ten, 6e-3);
  }
}

TEST(AsinhMagnitude, IsFiniteAndMonotoneThroughZero) {
  const double b = 1e-10;
  double last = kInfinity;
  for (double f = -1e-7; f <= 1e-7; f += 1e-10) {
    const double m = asinh_magnitude(f, b).value();
    EXPECT_TRUE(std::isfinite(m));
    EXPECT_LT(m, last);
    last = m;
  }
  EXPECT_NEAR(asinh_magnitude(1e200, b).value(), -500.0, 1e-9);
  EXPECT_NEAR(asinh_magnitude(-1e200, b).value(), 2.0 * asinh_magnitude(0.0, b).value() + 500.0, 1e-9);
}

TEST(AsinhMagnitude, IsTheUsualMagnitudeOfABrightStar) {
  const double f = 1e-4;  // 10 mag
  EXPECT_NEAR(asinh_magnitude(f, 1e-10).value(), 10.0, 2e-12);
  EXPECT_NEAR(asinh_magnitude_error(f, 1e-6, 1e-10).value(), magnitude_error(100.0).value(), 1e-13);
}

TEST(AsinhMagnitude, ErrorIsItsSlope) {
  const double b = 1e-10;
  for (const double f : {-3e-10, 0.0, 2e-10, 5e-9}) {
    const double h = 1e-14;
    const double slope = (asinh_magnitude(f - h, b).value() - asinh_magnitude(f + h, b).value()) / (2.0 * h);
    EXPECT_NEAR(asinh_magnitude_error(f, 1.0, b).value() / slope, 1.0, 1e-6);
  }
}

}  // namespace
}  // namespace astroid
