// The ramp fit of many pixels: the ladder of weights, saturation, and what is common to all reads.
#include "astroid/sim/ramp_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/frame.hpp"

namespace astroid {
namespace {

TEST(RampLadder, IsAsGoodAsOwnWeights) {
  double worst = 0.0;
  for (const int reads : {2, 3, 6, 16, 64}) {
    const int n = reads - 1;
    constexpr double kReadVariance = 30.0;
    const RampLadder ladder(RampFit::kOptimal, reads, kReadVariance);
    for (double electrons = 1e-3; electrons < 3e6; electrons *= 1.07) {
      const auto total = [&](const RampVariance& v) { return v.photon * electrons + v.readout * kReadVariance; };
      const double phi = photons_per_read_noise(RampFit::kOptimal, electrons, n, kReadVariance);
      const double own = total(RampWeights(n, phi).variance(n));
      worst = std::max(worst, total(ladder.variance(ladder.level(electrons), n)) / own - 1.0);
    }
  }
  std::printf("the ladder costs at most %.2g of the variance\n", worst);
  EXPECT_LT(worst, 1e-3);
}

TEST(RampLadder, TakesAnyExpectation) {
  const RampLadder ladder(RampFit::kOptimal, 8, 25.0);
  EXPECT_EQ(ladder.level(0.0), 0);
  EXPECT_EQ(ladder.level(-5.0), 0);
  EXPECT_EQ(ladder.level(std::nan("")), 0);
  EXPECT_EQ(ladder.level(1e-300), 0);
  EXPECT_EQ(ladder.level(1e300), ladder.level(1e12));
  int before = 0;
  for (double electrons = 1e-6; electrons < 1e9; electrons *= 1.01) {
    EXPECT_GE(ladder.level(electrons), before);
    before = ladder.level(electrons);
  }
  const RampLadder quiet(RampFit::kOptimal, 8, 0.0);
  EXPECT_EQ(quiet.level(0.0), 0);
  EXPECT_NEAR(quiet.variance(quiet.level(10.0), 7).photon, 1.0, 1e-15);  // the last read minus the first
}

/// One pixel read as given.
struct Ramp {
  float previous = 0.0F;
  double carried = 0.0, numerator = 0.0;
  std::uint8_t level = 0, used = 0, flags = 0;

  double fit(const RampLadder& ladder, const std::vector<float>& reads, int saturated_from = 1000) {
    const RampPixels pixels{{&level, 1}, {&previous, 1}, {&carried, 1}, {&numerator, 1}, {&used, 1}};
    for (int i = 0; i < static_cast<int>(reads.size()); ++i) {
      if (i >= saturated_from) flags |= pixel_flag::kFullWell;
      take_ramp_read(ladder, i, {&reads[static_cast<std::size_t>(i)], 1}, {&flags, 1}, pixels);
    }
    double counts = 0.0;
    finish_ramp(ladder, 60000.0, pixels, {&counts, 1}, {&flags, 1});
    return counts;
  }
};

TEST(RampPixels, FollowAStraightRamp) {
  for (const RampFit fit : {RampFit::kDifference, RampFit::kLeastSquares, RampFit::kOptimal}) {
    const RampLadder ladder(fit, 6, 100.0);
    Ramp ramp;
    ramp.level = ladder.level(500.0);
    EXPECT_NEAR(ramp.fit(ladder, {1000, 1100, 1200, 1300, 1400, 1500}), 500.0, 1e-10);
    EXPECT_EQ(ramp.flags, 0);
  }
}

TEST(RampPixels, ForgetWhatAllReadsHaveInCommon) {
  const RampLadder ladder(RampFit::kOptimal, 5, 100.0);
  Ramp ramp;
  Ramp shifted;
  ramp.level = shifted.level = ladder.level(300.0);
  const double value = ramp.fit(ladder, {100, 190, 251, 330, 409});
  EXPECT_EQ(shifted.fit(ladder, {1100, 1190, 1251, 1330, 1409}), value);
}

TEST(RampPixels, AreFittedToTheReadsBeforeSaturation) {
  const RampLadder ladder(RampFit::kOptimal, 6, 100.0);
  Ramp ramp;
  ramp.level = ladder.level(5e4);
  EXPECT_NEAR(ramp.fit(ladder, {1000, 11000, 21000, 30000, 30000, 30000}, 3), 50000.0, 1e-8);
  EXPECT_EQ(ramp.flags, pixel_flag::kShortRamp);
  EXPECT_EQ(ramp.used, 2);
}

TEST(RampPixels, KeepTheFlagWhereNothingIsLeftToFit) {
  const RampLadder ladder(RampFit::kOptimal, 6, 100.0);
  Ramp ramp;
  EXPECT_EQ(ramp.fit(ladder, {1000, 30000, 30000, 30000, 30000, 30000}, 1), 60000.0);
  EXPECT_EQ(ramp.flags, pixel_flag::kFullWell);
}

}  // namespace
}  // namespace astroid
