// The fast statistics of a cell against the sorted ones.
#include "mesh/cell_histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

struct Case {
  std::size_t count;
  double sigma, lit, quantum;
};

// Normal noise, and in a share of the pixels light of stars.
std::vector<float> cell_values(std::uint32_t seed, const Case& c) {
  const double level = 20.0 * c.sigma;
  const test::TestNoise noise(seed);
  std::vector<float> values;
  for (std::uint32_t i = 0; i < c.count; ++i) {
    double v = level + c.sigma * noise.normal(0, i);
    if (noise.uniform(1, i) < c.lit) v += c.sigma * std::exp(8.0 * noise.uniform(2, i) - 3.0);
    values.push_back(static_cast<float>(c.quantum > 0.0 ? c.quantum * std::floor(v / c.quantum + 0.5) : v));
  }
  return values;
}

class CellHistogramOf : public testing::TestWithParam<Case> {};

TEST_P(CellHistogramOf, IsTheSortedEstimate) {
  const Case& c = GetParam();
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const std::vector<float> values = cell_values(seed, c);
    std::vector<double> sorted(values.begin(), values.end());
    const SkyEstimate expected = clipped_sky(sorted, 3.0, false);
    detail::CellHistogram histogram;
    SkyEstimate sky;
    ASSERT_TRUE(histogram.fill(values, detail::quantum_of(values)));
    ASSERT_TRUE(histogram.clipped(3.0, false, sky));
    // Limits at edges of bins of 0.02 sigma move a value in a thousand; spread digits, those of whole steps.
    const double tolerance = c.quantum > 0.0 ? 0.02 : 0.01;
    EXPECT_NEAR(sky.level, expected.level, tolerance * expected.rms);
    EXPECT_NEAR(sky.mode, expected.mode, 4.0 * tolerance * expected.rms);
    EXPECT_NEAR(sky.rms, expected.rms, tolerance * expected.rms);
    EXPECT_NEAR(static_cast<double>(sky.pixels), static_cast<double>(expected.pixels),
                0.01 * static_cast<double>(c.count));
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, CellHistogramOf,
                         testing::Values(Case{4096, 5.0, 0.0, 0.0}, Case{4096, 5.0, 0.2, 0.0},
                                         Case{4096, 1e-4, 0.05, 0.0}, Case{1024, 5.0, 0.1, 0.0},
                                         Case{4096, 2.5, 0.1, 1.0}, Case{4096, 65.0, 0.1, 8.77}));

TEST(CellHistogram, LeavesToSortingWhatHasNoScatter) {
  detail::CellHistogram histogram;
  EXPECT_FALSE(histogram.fill(std::vector<float>(1000, 7.0F), 0.0));
  EXPECT_FALSE(histogram.fill(std::vector<float>(10, 7.0F), 0.0));
}

TEST(CellHistogram, SeesDigitisation) {
  EXPECT_EQ(detail::quantum_of(cell_values(3, {4096, 2.5, 0.0, 1.0})), 1.0);
  EXPECT_EQ(detail::quantum_of(cell_values(3, {4096, 2.5, 0.0, 0.0})), 0.0);
  EXPECT_EQ(detail::quantum_of(std::vector<float>(100, 3.0F)), 0.0);
}

TEST(CellHistogram, AddsEveryPixelOnceToScaledBins) {
  const std::vector<float> values = cell_values(5, {4096, 5.0, 0.0, 0.0});
  detail::CellHistogram histogram;
  ASSERT_TRUE(histogram.fill(values, 0.0));
  std::vector<double> bins(120, 0.0);
  histogram.add_scaled(100.0, 5.0, 6.0, 0.1, bins);
  double sum = 0.0;
  double mean = 0.0;
  for (std::size_t k = 0; k < bins.size(); ++k) {
    sum += bins[k];
    mean += bins[k] * (0.1 * (static_cast<double>(k) + 0.5) - 6.0);
  }
  EXPECT_NEAR(sum, 4096.0, 1e-6);
  double expected = 0.0;
  for (const float v : values) expected += (static_cast<double>(v) - 100.0) / 5.0;
  EXPECT_NEAR(mean / sum, expected / 4096.0, 0.005);
}

}  // namespace
}  // namespace astroid
