// SCIENCE N1, N2: moments, shape and additivity of Poisson draws at pixel addresses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "significance.hpp"

namespace astroid {
namespace {

constexpr std::size_t kRows = 400;
constexpr std::size_t kColumns = 1000;
constexpr double kDraws = kRows * kColumns;

std::vector<double> draws(double mean, std::uint32_t exposure) {
  const RandomStream stream = make_stream(20260101, StreamId{1}, 0, 0);
  const std::vector<double> means(kColumns, mean);
  std::vector<double> all(kRows * kColumns);
  for (std::size_t y = 0; y < kRows; ++y)
    poisson_row(stream, {0, static_cast<std::int32_t>(y), exposure, 0, 0}, means,
                std::span(all).subspan(y * kColumns, kColumns));
  return all;
}

TEST(PoissonDraws, HaveTheMeanAndVarianceOfTheDistribution) {
  std::uint32_t exposure = 0;
  for (const double mean :
       {1e-3, 0.1, 0.5, 3.0, 9.9, 10.0, 11.9, 12.1, 50.0, 745.0, 1300.0, 1e4, 1e5, 1e8, 1e10, 1e12, 1e14, 1e15}) {
    const std::vector<double> all = draws(mean, exposure++);
    long double sum = 0.0L;
    long double squares = 0.0L;
    for (const double n : all) {
      const long double d = static_cast<long double>(n) - static_cast<long double>(mean);
      sum += d;
      squares += d * d;
    }
    test::expect_within_errors(fmt::format("mean of Poisson({:g})", mean), static_cast<double>(sum) / kDraws,
                               std::sqrt(mean / kDraws));
    // The fourth central moment of a Poisson distribution is 3 mean^2 + mean.
    test::expect_within_errors(fmt::format("variance of Poisson({:g})", mean),
                               static_cast<double>(squares) / kDraws / mean - 1.0,
                               std::sqrt((2.0 + 1.0 / mean) / kDraws));
  }
}

TEST(PoissonDraws, AreAllZeroForAMeanOf1e9th) {
  const std::vector<double> all = draws(1e-9, 77);  // one or more with probability 4e-4 over all draws
  EXPECT_EQ(std::count(all.begin(), all.end(), 0.0), static_cast<std::ptrdiff_t>(all.size()));
}

TEST(PoissonDraws, HaveTheShapeOfTheDistribution) {
  constexpr double kSmallestExpected = 5.0;
  constexpr double kMostBins = 400.0;
  std::uint32_t exposure = 100;
  for (const double mean : {0.05, 0.5, 3.0, 9.99, 10.01, 11.9, 12.1, 50.0, 1300.0, 12345.6, 1e7, 1e11}) {
    std::vector<double> all = draws(mean, exposure++);
    std::sort(all.begin(), all.end());
    std::vector<double> observed;
    std::vector<double> expected;
    const double width = std::max(1.0, std::floor(16.0 * std::sqrt(mean) / kMostBins));
    double below = 0.0;  // expected number up to the last edge
    auto reached = all.begin();
    for (double n = std::max(0.0, std::floor(mean - 8.0 * std::sqrt(mean)));; n += width) {
      const double up_to = kDraws * poisson_cdf(n, mean);
      if (up_to - below < kSmallestExpected) continue;
      const bool last = kDraws * poisson_survival(n + width, mean) < 2.0 * kSmallestExpected;
      const auto edge = last ? all.end() : std::upper_bound(reached, all.end(), n);
      observed.push_back(static_cast<double>(edge - reached));
      expected.push_back((last ? kDraws : up_to) - below);
      if (last) break;
      below = up_to;
      reached = edge;
    }
    ASSERT_GT(observed.size(), 1U) << mean;
    test::expect_chi_squared(fmt::format("Poisson({:g}) in {} bins", mean, observed.size()), observed, expected);
  }
}

TEST(PoissonDraws, AddUpToPoissonDraws) {
  constexpr double kSmallestCount = 20.0;
  std::uint32_t exposure = 200;
  for (const auto& [a, b] :
       std::vector<std::pair<double, double>>{{0.2, 0.3}, {3.0, 8.9}, {6.1, 44.0}, {12.1, 700.0}}) {
    const std::vector<double> first = draws(a, exposure++);
    const std::vector<double> second = draws(b, exposure++);
    const std::vector<double> whole = draws(a + b, exposure++);
    std::map<double, std::pair<double, double>> histogram;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ++histogram[first[i] + second[i]].first;
      ++histogram[whole[i]].second;
    }
    double chi2 = 0.0;  // two samples of equal size: sum of (x - y)^2 / (x + y)
    double bins = 0.0;
    double x = 0.0;
    double y = 0.0;
    for (const auto& [n, pair] : histogram) {
      x += pair.first;
      y += pair.second;
      if (x + y < kSmallestCount) continue;
      chi2 += (x - y) * (x - y) / (x + y);
      ++bins;
      x = y = 0.0;
    }
    test::expect_probable(fmt::format("Poisson({}) + Poisson({})", a, b), chi2, gsl_cdf_chisq_Q(chi2, bins - 1.0));
  }
}

TEST(PoissonDraws, AreCoupledWhenOnlyTheMeanChanges) {
  // The same uniforms: a pixel brighter by 1 % draws the same or more, and the difference has little variance.
  const std::vector<double> faint = draws(1300.0, 300);
  const std::vector<double> bright = draws(1313.0, 300);
  double squares = 0.0;
  for (std::size_t i = 0; i < faint.size(); ++i) {
    ASSERT_GE(bright[i], faint[i]);
    squares += (bright[i] - faint[i] - 13.0) * (bright[i] - faint[i] - 13.0);
  }
  EXPECT_LT(squares / kDraws, 0.5);  // independent draws: 2613
}

}  // namespace
}  // namespace astroid
