#include "sub_pixel/deposit_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "astroid/core/error.hpp"

namespace astroid {
namespace {

constexpr long double kTwoPi = 6.28318530717958647692528676655900577L;

// The spectrum of what a star leaves on the nodes, divided by the kernel's.
std::complex<long double> ramp(const detail::DepositKernel& kernel, double x, double frequency) {
  const auto nodes = kernel.nodes(x);
  std::complex<long double> sum;
  for (std::size_t i = 0; i < kernel.width(); ++i)
    sum += static_cast<long double>(nodes.weights[i]) *
           std::polar(1.0L, -kTwoPi * static_cast<long double>(frequency) *
                                (static_cast<long double>(nodes.first) + static_cast<long double>(i)));
  return sum / static_cast<long double>(kernel.transform(frequency));
}

TEST(DepositKernel, MakesAStarAPurePhaseRamp) {
  for (const double band : {0.2, 1.0 / 3.0, 0.36}) {
    const detail::DepositKernel kernel(band);
    double worst = 0.0;
    double worst_inside = 0.0;
    for (const double x : {0.0, 0.5, 0.25, 0.1234567, 7.999999, -3.3, 1234.7})
      for (int i = -16; i <= 16; ++i) {
        const double f = band * i / 16.0;
        const auto exact = std::polar(1.0L, -kTwoPi * static_cast<long double>(f) * static_cast<long double>(x));
        const auto error = static_cast<double>(std::abs(ramp(kernel, x, f) - exact));
        (std::abs(i) <= 8 ? worst_inside : worst) = std::max(std::abs(i) <= 8 ? worst_inside : worst, error);
      }
    EXPECT_LT(worst_inside, 1e-14) << "band " << band << " width " << kernel.width();
    EXPECT_LT(worst, 1e-12) << "band " << band << " width " << kernel.width();
  }
}

TEST(DepositKernel, IsContinuousAcrossNodes) {
  const detail::DepositKernel kernel(1.0 / 3.0);
  constexpr double kStep = 1e-9;
  for (const double x : {-0.5, 0.0, 0.5, 1.0}) {
    for (const double f : {0.1, 0.3}) {
      const auto left = ramp(kernel, x - kStep, f);
      const auto right = ramp(kernel, x + kStep, f);
      EXPECT_LT(static_cast<double>(std::abs(left - right)), 3.0 * kTwoPi * f * kStep);
    }
  }
}

TEST(DepositKernel, RefusesABandThatTheMapCannotHold) {
  EXPECT_THROW(detail::DepositKernel(0.45), BugError);
}

}  // namespace
}  // namespace astroid
