#include "astroid/analysis/nsr_accumulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <thread>
#include <vector>

#include "astroid/test/gaussian_series.hpp"

namespace astroid {
namespace {

constexpr std::int64_t kHour = 144;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> noisy_series(std::size_t n, double offset, double sigma) {
  test::GaussianSeries gauss(20270101);
  std::vector<float> series(n);
  for (std::size_t i = 0; i < n; ++i) series[i] = static_cast<float>(offset + sigma * gauss.next());
  return series;
}

bool same_bits(const SeriesSummary& a, const SeriesSummary& b) {
  const auto values = [](const SeriesSummary& s) {
    return std::vector<double>{s.mean,
                               s.exposure.value,
                               s.exposure.low,
                               s.bin_within.value,
                               s.bin_within.error,
                               s.bin_means.value,
                               s.bin_means.high,
                               static_cast<double>(s.exposures),
                               static_cast<double>(s.missing),
                               static_cast<double>(s.bins)};
  };
  const std::vector<double> va = values(a);
  const std::vector<double> vb = values(b);
  return std::memcmp(va.data(), vb.data(), va.size() * sizeof(double)) == 0;
}

TEST(SeriesStatistics, AgreesWithTwoPasses) {
  const std::vector<float> series = noisy_series(kHour * 20, 0.01, 1e-3);
  SeriesStatistics statistics(1, kHour);
  statistics.add(0, 0, series);
  const SeriesSummary s = statistics.summary(0);

  long double sum = 0.0L;
  for (const float d : series) sum += static_cast<long double>(d);
  const long double mean = sum / static_cast<long double>(series.size());
  long double m2 = 0.0L;
  std::vector<long double> bin_mean(20, 0.0L);
  long double deviations = 0.0L;
  for (std::size_t b = 0; b < 20; ++b) {
    for (std::size_t i = 0; i < kHour; ++i) bin_mean[b] += static_cast<long double>(series[b * kHour + i]) / kHour;
    long double bin_m2 = 0.0L;
    for (std::size_t i = 0; i < kHour; ++i) {
      const long double d = static_cast<long double>(series[b * kHour + i]);
      m2 += (d - mean) * (d - mean);
      bin_m2 += (d - bin_mean[b]) * (d - bin_mean[b]);
    }
    deviations += std::sqrt(bin_m2 / (kHour - 1)) / static_cast<long double>(c4(kHour));
  }
  long double between = 0.0L;
  for (const long double x : bin_mean) between += (x - mean) * (x - mean);

  const double flux = 1.0 + static_cast<double>(mean);
  const double n = static_cast<double>(series.size());
  EXPECT_EQ(s.exposures, kHour * 20);
  EXPECT_EQ(s.bins, 20);
  EXPECT_NEAR(s.mean, static_cast<double>(mean), 1e-15);
  const double sigma = std::sqrt(static_cast<double>(m2) / (n - 1.0)) / c4(kHour * 20) / flux;
  EXPECT_NEAR(s.exposure.value / sigma, 1.0, 1e-12);
  EXPECT_NEAR(s.bin_within.value / (static_cast<double>(deviations) / 20.0 / 12.0 / flux), 1.0, 1e-12);
  EXPECT_NEAR(s.bin_means.value / (std::sqrt(static_cast<double>(between) / 19.0) / c4(20) / flux), 1.0, 1e-12);
}

TEST(SeriesStatistics, AreTheSameBitForBitHoweverTheExposuresAreCutIntoBlocks) {
  std::vector<float> series = noisy_series(1733, -0.02, 5e-3);  // the last bin is not full
  series[5] = kNan;
  series[700] = kNan;
  SeriesStatistics whole(1, kHour);
  whole.add(0, 0, series);
  for (const std::size_t block : {1U, 7U, 143U, 144U, 145U, 1024U}) {
    SeriesStatistics cut(1, kHour);
    for (std::size_t first = 0; first < series.size(); first += block) {
      const std::size_t count = std::min(block, series.size() - first);
      cut.add(0, static_cast<std::int64_t>(first), std::span(series).subspan(first, count));
      (void)cut.summary(0);  // looking does not disturb
    }
    EXPECT_TRUE(same_bits(whole.summary(0), cut.summary(0))) << "blocks of " << block;
  }
}

TEST(SeriesStatistics, AreTheSameBitForBitWhenStarsAreFedByThreads) {
  constexpr std::size_t kStars = 64;
  const std::vector<float> series = noisy_series(2000, 0.0, 1e-3);
  SeriesStatistics one(kStars, kHour);
  SeriesStatistics many(kStars, kHour);
  const auto feed = [&series](SeriesStatistics& statistics, std::size_t first, std::size_t step) {
    for (std::size_t star = first; star < kStars; star += step)
      statistics.add(star, 0, std::span(series).subspan(star));
  };
  feed(one, 0, 1);
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < 4; ++t) threads.emplace_back([&feed, &many, t] { feed(many, t, 4); });
  threads.clear();
  for (std::size_t star = 0; star < kStars; ++star) {
    EXPECT_TRUE(same_bits(one.summary(star), many.summary(star))) << star;
  }
}

TEST(SeriesStatistics, CountMissingExposuresAndLeaveThemOut) {
  const std::vector<float> holes{1e-3F, kNan, -1e-3F, kNan};
  SeriesStatistics statistics(2, 4);
  statistics.add(0, 0, holes);
  const SeriesSummary s = statistics.summary(0);
  EXPECT_EQ(s.exposures, 2);
  EXPECT_EQ(s.missing, 2);
  EXPECT_EQ(s.mean, 0.0);
  EXPECT_EQ(s.bins, 1);  // exactly half is enough
  EXPECT_NEAR(s.exposure.value, std::sqrt(2.0) * static_cast<double>(1e-3F) / c4(2), 1e-12);
  EXPECT_EQ(statistics.summary(1).exposures, 0);
  EXPECT_TRUE(std::isnan(statistics.summary(1).mean));
}

TEST(SeriesStatistics, LeaveBinsOutOfWhichLessThanHalfWasMeasured) {
  std::vector<float> series = noisy_series(kHour * 3, 0.0, 1e-3);
  std::fill(series.begin() + kHour, series.begin() + kHour + kHour / 2 + 1, kNan);
  SeriesStatistics statistics(1, kHour);
  statistics.add(0, 0, series);
  EXPECT_EQ(statistics.summary(0).bins, 2);
  EXPECT_EQ(statistics.summary(0).exposures, kHour * 3 - kHour / 2 - 1);
}

TEST(SeriesStatistics, GiveNoNoiseOfABinBeforeThereAreTwo) {
  SeriesStatistics statistics(1, kHour);
  statistics.add(0, 0, noisy_series(kHour + 3, 0.0, 1e-3));
  const SeriesSummary s = statistics.summary(0);
  EXPECT_EQ(s.bins, 1);
  EXPECT_TRUE(std::isfinite(s.bin_within.value));
  EXPECT_TRUE(std::isnan(s.bin_means.value));
}

TEST(SeriesStatistics, StandOnAPedestalAThousandTimesTheNoiseAndMore) {
  // Deviations of 1 ± 2^-20: the reference flux was half of the flux. The variance is known exactly.
  std::vector<float> series(kHour * 100);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] = 1.0F + (i % 2 == 0 ? 0x1p-20F : -0x1p-20F);
  SeriesStatistics statistics(1, kHour);
  statistics.add(0, 0, series);
  const SeriesSummary s = statistics.summary(0);
  const double n = static_cast<double>(series.size());
  EXPECT_NEAR(s.exposure.value * 2.0 * c4(kHour * 100) / (0x1p-20 * std::sqrt(n / (n - 1.0))), 1.0, 1e-12);
  EXPECT_NEAR(s.bin_means.value, 0.0, 1e-15);
}

TEST(SeriesStatistics, HaveNoRelativeNoiseWhereThereIsNoFlux) {
  SeriesStatistics statistics(1, 2);
  statistics.add(0, 0, std::vector<float>{-1.5F, -0.5F, -1.0F, -1.0F});
  EXPECT_TRUE(std::isnan(statistics.summary(0).exposure.value));
}

TEST(SeriesStatistics, KeepTheMeansOfBinsWhereAsked) {
  SeriesStatistics statistics(1, 4, true);
  const float gap = std::numeric_limits<float>::quiet_NaN();
  // Four bins: whole, with a value missing, with too few, and one that ends early.
  const std::vector<float> series{1, 2, 3, 4, 1, gap, 3, 5, gap, gap, gap, 7, 2, 4};
  statistics.add(0, 0, std::span(series).first(6));
  statistics.add(0, 6, std::span(series).subspan(6));
  const std::vector<float> means = statistics.bin_means(0, 4);
  ASSERT_EQ(means.size(), 4U);
  EXPECT_EQ(means[0], 2.5F);
  EXPECT_EQ(means[1], 3.0F);
  EXPECT_TRUE(std::isnan(means[2]));
  EXPECT_EQ(means[3], 3.0F);
  EXPECT_EQ(statistics.bin_means(0, 4).size(), 4U) << "asking takes nothing away";
  EXPECT_TRUE(SeriesStatistics(1, 4).bin_means(0, 4).empty());
}

TEST(SeriesStatistics, AcceptGapsBetweenBlocksButNeverGoBack) {
  SeriesStatistics statistics(1, 4);
  statistics.add(0, 0, std::vector<float>{0.0F, 0.1F});
  statistics.add(0, 100, std::vector<float>{0.0F, 0.1F});
  EXPECT_EQ(statistics.summary(0).bins, 2);
  EXPECT_ANY_THROW(statistics.add(0, 50, std::vector<float>{0.0F}));
}

}  // namespace
}  // namespace astroid
