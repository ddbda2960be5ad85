// The estimators of noise, each against its own expectation. Seeds are fixed, tolerances come from the sample size.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

#include "astroid/analysis/nsr_accumulator.hpp"
#include "astroid/core/jitter_noise.hpp"
#include "astroid/test/gaussian_series.hpp"

namespace astroid {
namespace {

constexpr std::int64_t kHour = 144;
constexpr double kSigma = 2e-3;

std::vector<SeriesSummary> white_noise(std::size_t stars, std::int64_t exposures, std::uint64_t seed) {
  test::GaussianSeries gauss(seed);
  SeriesStatistics statistics(stars, kHour);
  std::vector<float> series(static_cast<std::size_t>(exposures));
  for (std::size_t star = 0; star < stars; ++star) {
    for (float& d : series) d = static_cast<float>(kSigma * gauss.next());
    statistics.add(star, 0, series);
  }
  return statistics.summaries();
}

/// Unbiased (within 4 standard errors), with the stated error, and 95 % intervals that hold in 95 % of the cases.
template <class Pick>
void expect_honest(const std::vector<SeriesSummary>& all, double truth, Pick pick, const char* name) {
  std::vector<double> values;
  double stated = 0.0;
  double covered = 0.0;
  for (const SeriesSummary& s : all) {
    const NoiseEstimate& e = pick(s);
    values.push_back(e.value);
    stated += e.error / static_cast<double>(all.size());
    covered += e.low <= truth && truth <= e.high ? 1.0 : 0.0;
  }
  const MeanEstimate mean = mean_estimate(values);
  const double n = static_cast<double>(all.size());
  const double z = (mean.value - truth) / mean.error;
  std::cout << name << ": z = " << z << ", scatter / stated error = " << mean.scatter / stated
            << ", coverage = " << covered / n << '\n';
  EXPECT_LT(std::abs(z), 4.0) << name;
  EXPECT_NEAR(mean.scatter / stated, 1.0, 4.0 / std::sqrt(2.0 * n) + 0.02) << name;
  EXPECT_NEAR(covered / n, 0.95, 4.0 * std::sqrt(0.95 * 0.05 / n)) << name;
}

TEST(NoiseEstimators, AreUnbiasedWithHonestErrorsForWhiteNoise) {
  const std::vector<SeriesSummary> all = white_noise(2000, kHour * 12, 11);
  expect_honest(
      all, kSigma, [](const SeriesSummary& s) -> const NoiseEstimate& { return s.exposure; }, "exposure");
  expect_honest(
      all, kSigma / 12.0, [](const SeriesSummary& s) -> const NoiseEstimate& { return s.bin_within; }, "within bins");
  expect_honest(
      all, kSigma / 12.0, [](const SeriesSummary& s) -> const NoiseEstimate& { return s.bin_means; }, "bin means");
}

TEST(NoiseEstimators, StayUnbiasedWithMissingExposures) {
  test::GaussianSeries gauss(12);
  constexpr std::size_t kStars = 1000;
  SeriesStatistics statistics(kStars, kHour);
  std::vector<float> series(kHour * 12);
  for (std::size_t star = 0; star < kStars; ++star) {
    for (float& d : series) d = gauss.uniform() < 0.3 ? std::nanf("") : static_cast<float>(kSigma * gauss.next());
    statistics.add(star, 0, series);
  }
  const std::vector<SeriesSummary> all = statistics.summaries();
  expect_honest(
      all, kSigma / 12.0, [](const SeriesSummary& s) -> const NoiseEstimate& { return s.bin_within; }, "within bins");
  expect_honest(
      all, kSigma / 12.0, [](const SeriesSummary& s) -> const NoiseEstimate& { return s.bin_means; }, "bin means");
}

TEST(NoiseEstimators, SeeRedNoiseInBinMeansAsTheCovarianceSays) {
  // Points of an Ornstein-Uhlenbeck process, 250 s, every 25 s: the hourly mean keeps 0.360 of the rms, white
  // noise would keep 1/12. Within the hour the variance is what the mean has not taken.
  constexpr double kTimescale = 250.0;
  constexpr double kCycle = 25.0;
  constexpr std::size_t kStars = 400;
  test::GaussianSeries gauss(13);
  SeriesStatistics statistics(kStars, kHour);
  const double keep = std::exp(-kCycle / kTimescale);
  const double kick = std::sqrt(-std::expm1(-2.0 * kCycle / kTimescale));
  std::vector<float> series(kHour * 24);
  for (std::size_t star = 0; star < kStars; ++star) {
    double x = gauss.next();
    for (float& d : series) {
      d = static_cast<float>(kSigma * x);
      x = keep * x + kick * gauss.next();
    }
    statistics.add(star, 0, series);
  }
  const double kept = std::pow(ou_mean_rms(1.0, Seconds(kTimescale), {Seconds(kCycle), Seconds(0.0), kHour}), 2.0);
  double between = 0.0;
  std::vector<double> within;
  for (const SeriesSummary& s : statistics.summaries()) {
    between += s.bin_means.value * s.bin_means.value * c4(24) * c4(24) / kStars;
    within.push_back(s.bin_within.value);
  }
  // Successive hours are nearly independent (e^-14.4 at their distance): 23 * 400 degrees of freedom.
  const double expected = kSigma * kSigma * kept;
  EXPECT_NEAR(between / expected, 1.0, 4.0 * std::sqrt(2.0 / (23.0 * kStars)) + 0.01);
  const double n = static_cast<double>(kHour);
  const double inside = kSigma * std::sqrt((1.0 - kept) * n / (n - 1.0) / n);
  // The mean of the deviations is below the root of the mean variance: about 2 % for the 14 correlation times in an
  // hour.
  const MeanEstimate measured = mean_estimate(within);
  EXPECT_LT(measured.value, inside);
  EXPECT_NEAR(measured.value / inside, 1.0, 0.03);
}

}  // namespace
}  // namespace astroid
