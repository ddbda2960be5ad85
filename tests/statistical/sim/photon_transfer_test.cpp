// The whole detector chain seen from outside: flat fields give back their mean, Poisson variance, gain and readout
// noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

struct PairStatistics {
  double mean, difference_variance;
};

/// Two exposures of a flat field of `level` e- per pixel (and one negligible star, since a scene needs a target).
PairStatistics flat_pair(double level, Electrons readout, Gain gain) {
  constexpr int kSide = 500;
  Mission mission = test::bare_mission(kSide, kSide);
  mission.field.sky_background = ElectronsPerSecond(level / 21.0);
  mission.ccd.readout_noise = readout;
  mission.ccd.gain = gain;
  mission.ccd.bias = Adu(1000.0);
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{250.0, 250.0, 1e-6}}));
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ExposureState a = simulator.make_state();
  ExposureState b = simulator.make_state();
  simulator.simulate(0, a);
  simulator.simulate(1, b);
  const auto pa = a.frame.pixels.pixels();
  const auto pb = b.frame.pixels.pixels();
  const auto n = static_cast<double>(pa.size());
  double mean = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < pa.size(); ++i) {
    mean += 0.5 * (static_cast<double>(pa[i]) + static_cast<double>(pb[i])) / n;
    const double d = static_cast<double>(pa[i]) - static_cast<double>(pb[i]);
    squares += d * d / n;
  }
  return {mean, squares};
}

TEST(PhotonTransfer, FlatFieldHasPoissonVariance) {
  const PairStatistics flat = flat_pair(1e4, Electrons(0.0), Gain(1.0));
  const double n = 500.0 * 500.0;
  EXPECT_NEAR(flat.mean - 1000.0, 1e4, 5.0 * 100.0 / std::sqrt(2.0 * n));
  // Variance of the difference is twice the mean, plus twice the quantisation 1/12.
  EXPECT_NEAR(flat.difference_variance / (2.0 * 1e4 + 2.0 / 12.0), 1.0, 5.0 * std::sqrt(2.0 / n));
}

TEST(PhotonTransfer, CurveGivesBackGainAndReadoutNoise) {
  constexpr double kGain = 20.951;
  constexpr double kReadout = 50.2;
  const PairStatistics dark = flat_pair(1e-9, Electrons(kReadout), Gain(kGain));
  double sxx = 0.0;
  double sxy = 0.0;
  for (int i = 1; i <= 12; ++i) {
    const PairStatistics flat = flat_pair(4000.0 * i, Electrons(kReadout), Gain(kGain));
    const double signal = flat.mean - dark.mean;
    const double variance = 0.5 * (flat.difference_variance - dark.difference_variance);
    // Weighted by the variance of the variance, which grows as the signal squared.
    sxx += 1.0;
    sxy += variance / signal;
  }
  const double gain = sxx / sxy;
  const double readout = gain * std::sqrt(0.5 * dark.difference_variance - 1.0 / 12.0);
  std::printf("gain %.4f of %.4f e-/ADU, readout noise %.3f of %.3f e-\n", gain, kGain, readout, kReadout);
  EXPECT_NEAR(gain / kGain, 1.0, 0.005);
  EXPECT_NEAR(readout / kReadout, 1.0, 0.01);
}

}  // namespace
}  // namespace astroid
