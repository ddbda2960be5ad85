// Shape of uniforms and normals at pixel addresses, and independence of draws whose addresses differ in one field.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "significance.hpp"

namespace astroid {
namespace {

constexpr std::size_t kRows = 400;
constexpr std::size_t kColumns = 1000;
constexpr double kDraws = kRows * kColumns;
constexpr std::uint64_t kSeed = 20260101;
constexpr StreamId kEffect{2};

std::vector<double> normals(const RandomStream& stream, PixelAddress address) {
  std::vector<double> all(kRows * kColumns);
  for (std::size_t row = 0; row < kRows; ++row, ++address.y)
    normal_row(stream, address, std::span(all).subspan(row * kColumns, kColumns));
  return all;
}

TEST(NormalDraws, HaveTheMomentsOfTheStandardNormal) {
  const std::vector<double> all = normals(make_stream(kSeed, kEffect, 0, 0), {});
  double sums[7] = {};
  for (const double x : all)
    for (int k = 1; k <= 6; ++k) sums[k] += std::pow(x, k);
  // Variance of x^k: E x^2k - (E x^k)^2, with E x^2 = 1, 3, 15, 105, 945, 10395 for even powers.
  test::expect_within_errors("mean", sums[1] / kDraws, std::sqrt(1.0 / kDraws));
  test::expect_within_errors("variance", sums[2] / kDraws - 1.0, std::sqrt(2.0 / kDraws));
  test::expect_within_errors("third moment", sums[3] / kDraws, std::sqrt(15.0 / kDraws));
  test::expect_within_errors("fourth moment", sums[4] / kDraws - 3.0, std::sqrt(96.0 / kDraws));
  test::expect_within_errors("fifth moment", sums[5] / kDraws, std::sqrt(945.0 / kDraws));
  test::expect_within_errors("sixth moment", sums[6] / kDraws - 15.0, std::sqrt((10395.0 - 225.0) / kDraws));
}

TEST(NormalDraws, PassKolmogorovSmirnov) {
  std::vector<double> all = normals(make_stream(kSeed, kEffect, 0, 0), {});
  std::sort(all.begin(), all.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double cdf = 0.5 * std::erfc(-all[i] / std::sqrt(2.0));
    distance = std::max({distance, cdf - static_cast<double>(i) / kDraws, static_cast<double>(i + 1) / kDraws - cdf});
  }
  const double scaled = distance * std::sqrt(kDraws);
  double probability = 0.0;  // Kolmogorov's distribution, 2 sum (-1)^(k-1) exp(-2 k^2 t^2)
  for (int k = 1; k <= 100; ++k) probability += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * scaled * scaled);
  test::expect_probable("Kolmogorov-Smirnov distance * sqrt(n)", scaled, probability);
}

TEST(UniformDraws, FillTheIntervalEvenly) {
  constexpr std::size_t kBins = 1000;
  const RandomStream stream = make_stream(kSeed, kEffect, 0, 0);
  std::vector<double> observed(kBins);
  std::vector<double> row(kColumns);
  for (std::size_t y = 0; y < kRows; ++y) {
    uniform_row(stream, {0, static_cast<std::int32_t>(y), 0, 0, 0}, row);
    for (const double u : row) ++observed[static_cast<std::size_t>(u * kBins)];
  }
  test::expect_chi_squared("uniforms in 1000 bins", observed, std::vector<double>(kBins, kDraws / kBins));
}

TEST(StepDraws, AreStandardNormalAndUncorrelatedInTime) {
  const RandomStream stream = make_stream(kSeed, StreamId{3}, 0, 0);
  double sum = 0.0;
  double squares = 0.0;
  double lagged = 0.0;
  double axes = 0.0;
  double last = 0.0;
  for (std::uint64_t step = 0; step < kRows * kColumns; ++step) {
    const double x = normal_at_step(stream, {step, 0, 0});
    sum += x;
    squares += x * x;
    lagged += x * last;
    axes += x * normal_at_step(stream, {step, 1, 0});
    last = x;
  }
  test::expect_within_errors("mean over steps", sum / kDraws, std::sqrt(1.0 / kDraws));
  test::expect_within_errors("variance over steps", squares / kDraws - 1.0, std::sqrt(2.0 / kDraws));
  test::expect_within_errors("correlation of neighbouring steps", lagged / kDraws, std::sqrt(1.0 / kDraws));
  test::expect_within_errors("correlation of axes", axes / kDraws, std::sqrt(1.0 / kDraws));
}

/// Correlations of x y and x^2 y^2, and the joint distribution in 16 x 16 equally probable cells.
void expect_independent(const std::string& what, const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t kSide = 16;
  const auto cell = [](double x) {
    return std::min(kSide - 1,
                    static_cast<std::size_t>(0.5 * std::erfc(-x / std::sqrt(2.0)) * static_cast<double>(kSide)));
  };
  const auto n = static_cast<double>(a.size());
  double product = 0.0;
  double squares = 0.0;
  std::vector<double> observed(kSide * kSide);
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += a[i] * b[i];
    squares += (a[i] * a[i] - 1.0) * (b[i] * b[i] - 1.0);
    ++observed[cell(a[i]) * kSide + cell(b[i])];
  }
  test::expect_within_errors(what, product / n, std::sqrt(1.0 / n));
  test::expect_within_errors(what + ", squares", squares / n, 2.0 / std::sqrt(n));
  test::expect_chi_squared(what + ", joint", observed, std::vector<double>(observed.size(), n / (kSide * kSide)));
}

TEST(NormalDraws, AreIndependentWhenAnyFieldOfTheAddressDiffers) {
  const RandomStream stream = make_stream(kSeed, kEffect, 0, 0);
  const std::vector<double> base = normals(stream, {});
  expect_independent("next column", base, normals(stream, {1, 0, 0, 0, 0}));
  expect_independent("four columns on", base, normals(stream, {4, 0, 0, 0, 0}));
  expect_independent("next row", base, normals(stream, {0, 1, 0, 0, 0}));
  expect_independent("next exposure", base, normals(stream, {0, 0, 1, 0, 0}));
  expect_independent("next read", base, normals(stream, {0, 0, 0, 1, 0}));
  expect_independent("next draw", base, normals(stream, {0, 0, 0, 0, 1}));
  expect_independent("another effect", base, normals(make_stream(kSeed, StreamId{3}, 0, 0), {}));
  expect_independent("another camera", base, normals(make_stream(kSeed, kEffect, 1, 0), {}));
  expect_independent("another detector", base, normals(make_stream(kSeed, kEffect, 0, 1), {}));
  expect_independent("another seed", base, normals(make_stream(kSeed + 1, kEffect, 0, 0), {}));
}

}  // namespace
}  // namespace astroid
