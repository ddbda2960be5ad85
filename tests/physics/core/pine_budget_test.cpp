#include "astroid/core/pine_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace astroid {
namespace {

constexpr double kTolerance = 1e-3;  // ppm

TEST(PineBudget, ReproducesThePublishedBudget) {
  const PineBudget bright = pine_budget(Magnitude(8.0), 24.0);
  EXPECT_NEAR(bright.photon.value(), 10.1532, kTolerance);
  EXPECT_NEAR(bright.ccd_readout.value(), 0.8275, kTolerance);
  EXPECT_NEAR(bright.fee_readout.value(), 0.6911, kTolerance);
  EXPECT_NEAR(bright.other_photons.value(), 1.8953, kTolerance);
  EXPECT_NEAR(bright.smearing.value(), 0.2528, kTolerance);
  EXPECT_NEAR(bright.jitter.value(), 9.0036, kTolerance);
  EXPECT_NEAR(bright.breathing.value(), 0.3402, kTolerance);
  EXPECT_NEAR(bright.offset.value(), 0.0010, 1e-4);
  EXPECT_NEAR(bright.random.value(), 2.1951, kTolerance);
  EXPECT_NEAR(bright.systematic.value(), 9.0100, kTolerance);
  EXPECT_NEAR(bright.photon_and_random.value(), 10.3878, kTolerance);
  EXPECT_NEAR(bright.total.value(), 13.7509, kTolerance);

  const PineBudget faint = pine_budget(Magnitude(11.0), 24.0);
  EXPECT_NEAR(faint.photon.value(), 40.4207, kTolerance);
  EXPECT_NEAR(faint.ccd_readout.value(), 13.1148, kTolerance);
  EXPECT_NEAR(faint.fee_readout.value(), 10.9536, kTolerance);
  EXPECT_NEAR(faint.other_photons.value(), 16.5689, kTolerance);
  EXPECT_NEAR(faint.smearing.value(), 4.0068, kTolerance);
  EXPECT_NEAR(faint.jitter.value(), 9.0036, kTolerance);
  EXPECT_NEAR(faint.breathing.value(), 0.3402, kTolerance);
  EXPECT_NEAR(faint.offset.value(), 0.0160, 1e-4);
  EXPECT_NEAR(faint.random.value(), 24.1363, kTolerance);
  EXPECT_NEAR(faint.systematic.value(), 9.0100, kTolerance);
  EXPECT_NEAR(faint.photon_and_random.value(), 47.0786, kTolerance);
  EXPECT_NEAR(faint.total.value(), 47.9330, kTolerance);
}

TEST(PineBudget, MeetsTheRequirementForEveryNumberOfCameras) {
  for (const double cameras : {6.0, 12.0, 18.0, 24.0}) {
    EXPECT_LT(pine_budget(Magnitude(11.0), cameras).photon_and_random.value(), 50.0 * std::sqrt(24.0 / cameras));
  }
}

TEST(PineBudget, AveragesEverythingButJitterOverCameras) {
  const PineBudget one = pine_budget(Magnitude(10.0), 1.0);
  const PineBudget four = pine_budget(Magnitude(10.0), 4.0);
  EXPECT_NEAR(four.photon_and_random / one.photon_and_random, 0.5, 1e-14);
  EXPECT_NEAR(four.breathing / one.breathing, 0.5, 1e-14);
  EXPECT_EQ(four.jitter, one.jitter);
}

}  // namespace
}  // namespace astroid
