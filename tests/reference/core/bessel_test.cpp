#include "bessel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace astroid {
namespace {

TEST(Bessel, AgreesWithTheIntegral) {
  // J1(x) = 1/pi times the integral of cos(t - x sin t) from 0 to pi, by the trapezium rule, which converges beyond all
  // orders for a periodic integrand.
  constexpr int kPoints = 400;
  constexpr long double kPiLong = 3.14159265358979323846264338327950288L;
  double worst = 0.0;
  for (int i = -400; i <= 8000; ++i) {
    const double x = 0.03125 * i;  // meets both borders between methods
    long double sum = 0.0L;
    for (int k = 0; k < kPoints; ++k) {
      const long double t = 2.0L * kPiLong * k / kPoints;
      sum += std::cos(t - static_cast<long double>(x) * std::sin(t));
    }
    worst = std::max(worst, std::abs(detail::bessel_j1(x) - static_cast<double>(sum / kPoints)));
  }
  std::cout << "largest difference " << worst << "\n";
  EXPECT_LT(worst, 3e-15);
}

TEST(Bessel, OverItsArgumentIsSmoothAtZero) {
  EXPECT_EQ(detail::jinc(0.0), 1.0);
  EXPECT_EQ(detail::jinc(1e-200), 1.0);
  EXPECT_NEAR(detail::jinc(1e-3), 1.0 - 1e-6 / 8.0, 1e-13);
  EXPECT_NEAR(detail::jinc(3.8317059702075123), 0.0, 1e-15);  // the first dark ring, 1.2197 pi
}

}  // namespace
}  // namespace astroid
