// Ramp fits: the prefix sums are generalised least squares, their variances the textbook's.
#include "astroid/core/ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace astroid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Solves C x = b by Gaussian elimination in long double: the slow oracle.
std::vector<long double> solve(std::vector<std::vector<long double>> c, std::vector<long double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const long double factor = c[i][k] / c[k][k];
      for (std::size_t j = k; j < n; ++j) c[i][j] -= factor * c[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= c[k][j] * b[j];
    b[k] /= c[k][k];
  }
  return b;
}

/// Generalised least squares on the reads themselves, with an unknown level common to all of them: weights of the reads
/// 0 … m for the electrons of n intervals.
std::vector<long double> read_weights(int n, int m, long double phi) {
  // Normal equations of level a and electrons F: y_i = a + F i / n, covariance φ min(i, j) + δ_ij.
  const auto size = static_cast<std::size_t>(m) + 1;
  std::vector<std::vector<long double>> c(size, std::vector<long double>(size));
  std::vector<long double> level(size, 1.0L);
  std::vector<long double> slope(size);
  for (std::size_t i = 0; i < size; ++i) {
    slope[i] = static_cast<long double>(i) / n;
    for (std::size_t j = 0; j < size; ++j)
      c[i][j] = phi * static_cast<long double>(std::min(i, j)) + (i == j ? 1.0L : 0.0L);
  }
  const std::vector<long double> u = solve(c, level);
  const std::vector<long double> v = solve(c, slope);
  long double uu = 0.0L;
  long double uv = 0.0L;
  long double vv = 0.0L;
  for (std::size_t i = 0; i < size; ++i) {
    uu += level[i] * u[i];
    uv += level[i] * v[i];
    vv += slope[i] * v[i];
  }
  std::vector<long double> w(size);
  for (std::size_t i = 0; i < size; ++i) w[i] = (uu * v[i] - uv * u[i]) / (uu * vv - uv * uv);
  return w;
}

TEST(RampWeights, AreGeneralisedLeastSquaresOnTheReads) {
  double worst = 0.0;
  for (const int n : {1, 2, 3, 7, 15, 31}) {
    for (const double phi : {0.0, 1e-9, 1e-3, 0.3, 1.0, 40.0, 1e6}) {
      const RampWeights ramp(n, phi);
      for (int m = 1; m <= n; ++m) {
        const std::vector<double> w = ramp.weights(m);
        const std::vector<long double> reads = read_weights(n, m, phi);
        for (int i = 0; i <= m; ++i) {
          // Read i ends increment i and begins increment i + 1.
          const double got =
              (i > 0 ? w[static_cast<std::size_t>(i) - 1] : 0.0) - (i < m ? w[static_cast<std::size_t>(i)] : 0.0);
          const auto want = static_cast<double>(reads[static_cast<std::size_t>(i)]);
          worst = std::max(worst, std::abs(got - want) / static_cast<double>(n));
        }
      }
    }
  }
  std::printf("largest difference %.2g\n", worst);
  EXPECT_LT(worst, 1e-11);  // the oracle loses digits where φ is 1e6
}

TEST(RampWeights, OfPrefixSumsAreTheWeightsThemselves) {
  for (const double phi : {0.0, 0.1, 5.0, 1e4}) {
    const RampWeights ramp(9, phi);
    for (int m = 1; m <= 9; ++m) {
      const std::vector<double> w = ramp.weights(m);
      double direct = 0.0;
      double z = 0.0;
      double numerator = 0.0;
      double sum = 0.0;
      for (int i = 1; i <= m; ++i) {
        const double d = 100.0 + 7.0 * std::sin(3.0 * i);
        direct += w[static_cast<std::size_t>(i) - 1] * d;
        sum += w[static_cast<std::size_t>(i) - 1];
        z = d + ramp.carry(i) * z;
        numerator += ramp.share(i) * z;
      }
      EXPECT_NEAR(9.0 * numerator / ramp.information(m) / direct, 1.0, 1e-14);
      EXPECT_NEAR(sum, 9.0, 1e-12);  // a straight ramp comes out as it is
    }
  }
}

TEST(RampWeights, WithoutPhotonsHaveTheVarianceOfAStraightLine) {
  for (const int reads : {2, 3, 5, 8, 16, 64}) {
    const double r = reads;
    const RampVariance v = RampWeights(reads - 1, 0.0).variance(reads - 1);
    // Vacca2004, in electrons of the time from the first read to the last.
    EXPECT_NEAR(v.photon / (1.2 * (r * r + 1.0) / (r * (r + 1.0))), 1.0, 1e-12) << reads;
    EXPECT_NEAR(v.readout / (12.0 * (r - 1.0) / (r * (r + 1.0))), 1.0, 1e-12) << reads;
  }
}

TEST(RampWeights, WithoutReadoutNoiseAreTheLastReadMinusTheFirst) {
  const RampWeights ramp(12, kInfinity);
  for (int m = 1; m <= 12; ++m)
    for (const double w : ramp.weights(m)) EXPECT_EQ(w, 12.0 / m);
  EXPECT_NEAR(ramp.variance(12).photon, 1.0, 1e-15);
  EXPECT_NEAR(ramp.variance(12).readout, 2.0, 1e-15);
}

TEST(RampWeights, OptimalOnesHaveTheLeastVarianceOfAll) {
  constexpr int kIntervals = 15;
  for (const double phi : {1e-4, 0.01, 0.3, 2.0, 50.0}) {
    const auto total = [&](double other) {
      const RampVariance v = RampWeights(kIntervals, other).variance(kIntervals);
      return v.photon * phi * kIntervals + v.readout;
    };
    const double best = total(phi);
    for (const double other : {0.0, 0.5 * phi, 0.9 * phi, 1.1 * phi, 2.0 * phi, kInfinity})
      EXPECT_GT(total(other), best) << phi << " " << other;
    // Weights for a charge a tenth off lose nothing that counts.
    EXPECT_LT(total(1.1 * phi) / best, 1.0005);
  }
}

TEST(RampNoise, OfASingleReadIsThatOfAReset) {
  const RampNoise noise{.reads = 1};
  EXPECT_EQ(noise.variance(1e4, 25.0).photon, 1.0);
  EXPECT_EQ(noise.variance(1e4, 25.0).readout, 1.0);
}

TEST(RampNoise, GrowsWhenReadsSaturate) {
  const RampNoise noise{.reads = 9, .fit = RampFit::kDifference, .full_well = 8000.0};
  EXPECT_EQ(noise.usable_intervals(7999.0), 8);
  EXPECT_EQ(noise.usable_intervals(8000.0), 7);  // the last read is full
  EXPECT_EQ(noise.usable_intervals(16000.0), 3);
  EXPECT_EQ(noise.usable_intervals(63000.0), 1);
  EXPECT_EQ(noise.usable_intervals(64000.0), 0);
  EXPECT_NEAR(noise.variance(16000.0, 4.0).photon, 8.0 / 3.0, 1e-12);
}

}  // namespace
}  // namespace astroid
