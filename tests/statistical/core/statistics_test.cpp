// Estimators on Gaussian noise with fixed seeds; tolerances follow from the number of draws, z is printed on failure.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/statistics/allan.hpp"
#include "astroid/core/statistics/gaussianity.hpp"
#include "astroid/core/statistics/regression.hpp"
#include "astroid/core/statistics/robust.hpp"
#include "astroid/core/statistics/sums.hpp"

namespace astroid {
namespace {

std::vector<double> gaussian_noise(std::uint64_t seed, std::size_t n) {
  const RandomStream stream = make_stream(seed, StreamId{900}, 0, 0);
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    const RandomWords words = philox4x32(stream, {static_cast<std::uint32_t>(i / 4), 0, 0, 0});
    values[i] = standard_normal(words[i % 4]);
  }
  return values;
}

TEST(SigmaClip, NarrowsGaussianNoiseByItsKnownFactor) {
  const std::size_t n = 1000000;
  const auto noise = gaussian_noise(1, n);
  RunningMoments all;
  for (const double x : noise) all.add(x);
  for (const double k : {2.5, 3.0, 4.0}) {
    const ClippedSample once = sigma_clip(noise, {.low = k, .high = k, .passes = 1, .about_median = false});
    const double ratio = once.deviation / all.standard_deviation();
    const double error = 1.0 / std::sqrt(2.0 * static_cast<double>(n));  // of a deviation; of the ratio it is less
    EXPECT_LT(std::abs(ratio - clipped_deviation_factor(k)) / error, 3.0) << k;
  }
}

TEST(RobustSpread, OfGaussianNoiseIsItsStandardDeviation) {
  const std::size_t n = 400000;
  const RobustSpread spread = robust_spread(gaussian_noise(2, n));
  const double error = std::sqrt(1.0 / (2.0 * 0.3675 * static_cast<double>(n)));  // efficiency 36.75 %
  EXPECT_LT(std::abs(spread.value - 1.0) / error, 4.0);
}

TEST(AndersonDarling, AcceptsGaussianNoiseAsOftenAsItSays) {
  int accepted = 0;
  int rejected_contaminated = 0;
  constexpr int kSeeds = 400;
  for (int seed = 0; seed < kSeeds; ++seed) {
    auto noise = gaussian_noise(static_cast<std::uint64_t>(100 + seed), 500);
    const AndersonDarling test = anderson_darling(noise);
    EXPECT_EQ(test.p_value > 0.05, test.statistic < kAndersonDarlingFivePercent + 3e-3) << test.statistic;
    if (test.statistic < kAndersonDarlingFivePercent) ++accepted;
    for (std::size_t i = 0; i < noise.size(); i += 20) noise[i] += 5.0;  // 5 % hit by cosmic rays
    if (anderson_darling(noise).statistic > kAndersonDarlingFivePercent) ++rejected_contaminated;
  }
  EXPECT_NEAR(accepted, 0.95 * kSeeds, 0.03 * kSeeds);
  EXPECT_GT(rejected_contaminated, 0.95 * kSeeds);
}

double slope_of(const std::vector<double>& series) {
  std::vector<double> x;
  std::vector<double> y;
  for (const std::int64_t m : {1, 2, 4, 8, 16, 32}) {
    const AllanDeviation point = overlapping_allan_deviation(series, m);
    if (!point.valid()) continue;
    x.push_back(std::log(static_cast<double>(m)));
    y.push_back(std::log(point.value));
  }
  return fit_line(x, y).slope;
}

TEST(AllanDeviation, OfWhiteNoiseFallsWithTheRootOfTheLength) {
  auto noise = gaussian_noise(7, 200000);
  EXPECT_NEAR(slope_of(noise), -0.5, 0.02);
  EXPECT_NEAR(allan_deviation(noise, 1).value, 1.0, 5.0 * std::sqrt(0.75 / 200000));
}

TEST(AllanDeviation, OfWhiteNoiseWithGapsStillDoes) {
  auto noise = gaussian_noise(8, 200000);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (i % 1000 >= 700) noise[i] = std::numeric_limits<double>::quiet_NaN();  // 30 %
  }
  EXPECT_NEAR(slope_of(noise), -0.5, 0.05);
}

TEST(AllanDeviation, OfARandomWalkRisesWithTheRootOfTheLength) {
  auto walk = gaussian_noise(9, 200000);
  for (std::size_t i = 1; i < walk.size(); ++i) walk[i] += walk[i - 1];
  std::vector<double> x;
  std::vector<double> y;
  for (const std::int64_t m : {8, 16, 32, 64, 128}) {
    x.push_back(std::log(static_cast<double>(m)));
    y.push_back(std::log(overlapping_allan_deviation(walk, m).value));
  }
  EXPECT_NEAR(fit_line(x, y).slope, 0.5, 0.05);
}

TEST(FitLine, ReportsErrorsThatMatchItsScatter) {
  std::vector<double> x(50);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  RunningMoments pulls;
  constexpr int kFits = 2000;
  for (int seed = 0; seed < kFits; ++seed) {
    const Line line = fit_line(x, gaussian_noise(static_cast<std::uint64_t>(5000 + seed), x.size()));
    pulls.add(line.slope / line.slope_error);
  }
  // Student's t with 48 degrees of freedom has variance 48 / 46.
  EXPECT_NEAR(pulls.variance() / (48.0 / 46.0), 1.0, 4.0 * variance_relative_error(kFits));
  EXPECT_LT(std::abs(pulls.mean()) * std::sqrt(kFits), 4.0);
}

}  // namespace
}  // namespace astroid
