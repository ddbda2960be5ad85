// The covariance of two staggered means of an Ornstein-Uhlenbeck process is the double integral of its covariance.
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/jitter_noise.hpp"

namespace astroid {
namespace {

/// By midpoints, of e^(-|t - u| / tau) over both series.
double by_midpoints(double tau, const Cadence& cadence, double lag) {
  constexpr int kSteps = 400;
  const double cycle = cadence.cycle.value();
  const double exposure = cadence.exposure_time.value();
  const auto exposures = static_cast<int>(cadence.exposures);
  const double h = exposure / kSteps;
  double sum = 0.0;
  for (int j = 0; j < exposures; ++j)
    for (int k = 0; k < exposures; ++k)
      for (int a = 0; a < kSteps; ++a)
        for (int b = 0; b < kSteps; ++b) {
          const double t = j * cycle + (a + 0.5) * h;
          const double u = lag + k * cycle + (b + 0.5) * h;
          sum += std::exp(-std::fabs(t - u) / tau);
        }
  const double points = static_cast<double>(exposures) * kSteps;
  return sum / (points * points);
}

TEST(OuMeanCovariance, IsTheIntegralOfTheCovarianceOfInstants) {
  for (const double tau : {3.0, 40.0, 250.0})
    for (const double lag : {0.0, 6.25, -12.5, 18.75, 22.0})
      for (const int exposures : {1, 3}) {
        const Cadence cadence{Seconds(25), Seconds(21), exposures};
        // Midpoints err by the kink: h² / (6 T tau) of the integral at most.
        EXPECT_NEAR(ou_mean_covariance(Seconds(tau), cadence, Seconds(lag)), by_midpoints(tau, cadence, lag), 2e-5)
            << tau << " " << lag << " " << exposures;
      }
}

TEST(OuMeanCovariance, IsContinuousAtNoLagAndEven) {
  const Cadence hour{Seconds(25), Seconds(21), 144};
  const double rms = ou_mean_rms(1.0, Seconds(250), hour);
  EXPECT_EQ(ou_mean_covariance(Seconds(250), hour, Seconds(0)), rms * rms);
  EXPECT_NEAR(ou_mean_covariance(Seconds(250), hour, Seconds(1e-9)), rms * rms, 1e-12);
  EXPECT_DOUBLE_EQ(ou_mean_covariance(Seconds(250), hour, Seconds(7)),
                   ou_mean_covariance(Seconds(250), hour, Seconds(-7)));
}

TEST(OuMeanCovariance, IsThatOfInstantsForShortExposuresAndFiniteForShortTimescales) {
  EXPECT_NEAR(ou_mean_covariance(Seconds(100), {Seconds(25), Seconds(1e-6), 1}, Seconds(10)), std::exp(-0.1), 1e-8);
  EXPECT_NEAR(ou_mean_covariance(Seconds(100), {Seconds(25), Seconds(0), 1}, Seconds(10)), std::exp(-0.1), 1e-15);
  EXPECT_EQ(ou_mean_covariance(Seconds(1e-3), {Seconds(25), Seconds(21), 1}, Seconds(24)), 0.0);
}

}  // namespace
}  // namespace astroid
