#include "astroid/core/photometric.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace astroid {
namespace {

TEST(ZeroPoint, OfTheMissionsThroughputAgreesWithItsTable) {
  // The rate at V = 0 tabulated by the mission is 2.50e8 e-/s, and 0.38 mag separate V from P for a G2 dwarf.
  EXPECT_NEAR(magnitude_of(ElectronsPerSecond(2.50e8), Magnitude(0.0))->value(), -20.995, 5e-4);
  const Magnitude chain = zero_point({.photon_flux = 1.00179e8,
                                      .bandwidth = 500.0,
                                      .area = 0.01131,
                                      .transmission = 0.8125 * 0.920 * 0.989 * 0.972 * 0.9573,
                                      .quantum_efficiency = 0.6267 * 1.01});
  EXPECT_NEAR(electron_rate(Magnitude(0.0), chain).value() / 2.467e8, 1.0, 5e-4);
  const double table[] = {1.58e5, 6.29e4, 2.50e4, 9.97e3, 3.97e3, 1.58e3};  // e-/s at V = 8 … 13
  for (int v = 8; v <= 13; ++v) {
    EXPECT_NEAR(electron_rate(Magnitude(v), Magnitude(20.995)).value() / table[v - 8], 1.0, 4e-3) << v;
  }
}

TEST(Magnitude, RoundTripsThroughElectrons) {
  const Magnitude zp(20.62);
  for (const double m : {-30.0, -1.46, 0.0, 4.83, 11.0, 20.62, 40.0}) {
    EXPECT_NEAR(magnitude_of(electron_rate(Magnitude(m), zp), zp)->value(), m, 2e-14);
  }
}

TEST(MagnitudeError, IsPogsonsFactorOverTheSignalToNoise) {
  EXPECT_DOUBLE_EQ(magnitude_error(1.0).value(), 2.5 / std::log(10.0));
  const MagnitudeInterval interval = magnitude_interval(100.0);
  EXPECT_NEAR(interval.bright.value(), -10.803e-3, 5e-7);
  EXPECT_NEAR(interval.faint.value(), 10.912e-3, 5e-7);
}

TEST(MeanMagnitudeBias, ReproducesTheSumOverThePoissonLaw) {
  EXPECT_NEAR(mean_magnitude_bias(100.0).value(), 5.43e-3, 5e-6);
  // E[-2.5 log10 N] over N >= 1 of the Poisson law of mean 100, whose next order in 1/mean is 5/6 of 1/mean.
  const double mean = 100.0;
  double probability = std::exp(-mean);
  double expected = 0.0;
  for (int n = 1; n < 300; ++n) {
    probability *= mean / n;
    expected += probability * -2.5 * std::log10(n / mean);
  }
  EXPECT_NEAR(mean_magnitude_bias(mean).value() / expected, 1.0, 1.0 / mean);
}

TEST(Contamination, RelationsReproduceReferenceValues) {
  EXPECT_NEAR(contamination_shift(0.01).value(), -10.80e-3, 5e-6);
  EXPECT_NEAR(contamination_shift(0.10).value(), -103.5e-3, 5e-5);
  EXPECT_NEAR(contamination_shift(1.0).value(), -0.7526, 5e-5);
  for (const double c : {0.0, 1e-6, 0.3, 5.0}) {
    EXPECT_NEAR(contaminant_ratio(spr_from_ratio(c)), c, 1e-15 + 1e-14 * c);
    EXPECT_NEAR(crowdsap(spr_from_ratio(c)), 1.0 / (1.0 + c), 1e-15);
  }
}

}  // namespace
}  // namespace astroid
