// A billion and more draws of the kernels against their exact distributions: moments, shape, tails, independence.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "astroid/core/pixel_noise.hpp"
#include "significance.hpp"

namespace astroid {
namespace {

constexpr std::uint64_t kSeed = 20260101;
constexpr StreamId kEffect{7};
constexpr int kRows = 64;
constexpr int kColumns = 1024;
constexpr std::size_t kFrame = static_cast<std::size_t>(kRows) * kColumns;

/// Kolmogorov's distribution: probability of a larger distance * sqrt(n).
double kolmogorov(double scaled) {
  double probability = 0.0;
  for (int k = 1; k <= 100; ++k) probability += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * scaled * scaled);
  return std::clamp(probability, 0.0, 1.0);
}

constexpr Rectangle kArea{0, 0, kColumns, kRows};

PixelPlaces frame(std::size_t number) {
  return {.areas = {&kArea, 1}, .exposure = static_cast<std::uint32_t>(number)};
}

/// A histogram of whole numbers about the mean, in bins of a whole width.
class CountHistogram {
 public:
  CountHistogram(double mean, double bins)
      : width_(std::max(1.0, std::floor(18.0 * std::sqrt(mean) / bins))),
        first_(std::max(0.0, std::floor(mean - 9.0 * std::sqrt(mean)))),
        counts_(static_cast<std::size_t>((18.0 * std::sqrt(mean) + 64.0) / width_) + 2, 0.0) {}
  void add(std::span<const double> draws) {
    const double per_width = 1.0 / width_;
    const auto last = static_cast<double>(counts_.size() - 1);
    for (const double n : draws)
      ++counts_[static_cast<std::size_t>(std::clamp(std::floor((n - first_) * per_width + 1.0), 0.0, last))];
  }
  [[nodiscard]] std::size_t bins() const { return counts_.size(); }
  [[nodiscard]] double count(std::size_t bin) const { return counts_[bin]; }
  /// The largest count in a bin; the first bin holds all that is below `first_`.
  [[nodiscard]] double upper_edge(std::size_t bin) const { return first_ - 1.0 + width_ * static_cast<double>(bin); }

 private:
  double width_;
  double first_;
  std::vector<double> counts_;
};

/// chi-squared over bins of enough draws, and the Kolmogorov-Smirnov distance over all edges.
void expect_shape(const CountHistogram& histogram, double mean, double draws) {
  constexpr double kSmallestExpected = 20.0;
  std::vector<double> observed;
  std::vector<double> expected;
  double cumulated = 0.0;
  double open_observed = 0.0;
  double below = 0.0;
  double distance = 0.0;
  for (std::size_t bin = 0; bin < histogram.bins(); ++bin) {
    const bool last = bin + 1 == histogram.bins();
    const double edge = histogram.upper_edge(bin);
    const double up_to = last ? 1.0 : edge < 0.0 ? 0.0 : poisson_cdf(edge, mean);
    cumulated += histogram.count(bin);
    open_observed += histogram.count(bin);
    distance = std::max(distance, std::fabs(cumulated / draws - up_to));
    const double left = last ? 0.0 : poisson_survival(std::max(edge, 0.0), mean);
    if (!last && (draws * (up_to - below) < kSmallestExpected || draws * left < kSmallestExpected)) continue;
    if (last && !observed.empty() && draws * (up_to - below) < kSmallestExpected) {
      observed.back() += open_observed;
      expected.back() += draws * (up_to - below);
    } else {
      observed.push_back(open_observed);
      expected.push_back(draws * (up_to - below));
    }
    open_observed = 0.0;
    below = up_to;
  }
  if (observed.size() > 1)
    test::expect_chi_squared(fmt::format("Poisson({:g}), chi-squared in {} bins", mean, observed.size()), observed,
                             expected);
  // For a discrete distribution Kolmogorov's is an upper bound of the probability, so only a small one counts.
  const double probability = kolmogorov(distance * std::sqrt(draws));
  std::printf("  %-46s D sqrt(n) = %.3f, p >= %.3f\n", "Kolmogorov-Smirnov", distance * std::sqrt(draws), probability);
  EXPECT_GT(probability, test::kSmallestProbability) << mean;
}

/// Counts beyond 5 sigma on either side, against the exact probability, by the exact test of a Poisson number.
void expect_tail(const std::string& what, double observed, double expected) {
  const double more = observed > 0.0 ? poisson_survival(observed - 1.0, expected) : 1.0;
  const double fewer = poisson_cdf(observed, expected);
  std::printf("  %-46s %.0f, expected %.2f\n", what.c_str(), observed, expected);
  EXPECT_GT(std::min(more, fewer), 1e-5) << what;
}

TEST(BillionDraws, OfPoissonCountsHaveTheirDistributionAtTwentyMeans) {
  const std::array<double, 20> means{1e-6, 1e-3, 0.03, 0.3,  1.0,   3.0, 7.5, 9.999, 10.001, 15.0,
                                     30.0, 60.0, 250., 945., 12345, 1e6, 3e7, 1e9,   1e10,   1e12};
  constexpr std::size_t kFrames = 770;  // 50 million draws a mean, a billion in all
  constexpr auto kDraws = static_cast<double>(kFrames * kFrame);
  std::vector<double> mean(kFrame);
  std::vector<double> counts(kFrame);
  double all = 0.0;
  for (std::size_t m = 0; m < means.size(); ++m) {
    const double mu = means[m];
    // Where almost every draw needs more than the fast paths, fewer of them.
    const std::size_t frames = mu > 1e9 ? kFrames / 5 : mu == 10.001 || mu == 7.5 ? kFrames * 13 / 10 : kFrames;
    const auto draws = static_cast<double>(frames * kFrame);
    const double sigma = std::sqrt(mu);
    std::ranges::fill(mean, mu);
    CountHistogram histogram(mu, 4000.0);
    const RandomStream stream = make_stream(kSeed, kEffect, static_cast<std::uint32_t>(m), 0);
    double sum = 0.0;
    double squares = 0.0;
    double cubes = 0.0;
    double low = 0.0;
    double high = 0.0;
    for (std::size_t f = 0; f < frames; ++f) {
      pixel_poisson(stream, frame(f), mean, counts);
      histogram.add(counts);
      double frame_sum = 0.0;
      double frame_squares = 0.0;
      double frame_cubes = 0.0;
      for (const double n : counts) {
        const double z = (n - mu) / sigma;
        frame_sum += z;
        frame_squares += z * z;
        frame_cubes += z * z * z;
        low += z < -5.0 ? 1.0 : 0.0;
        high += z > 5.0 ? 1.0 : 0.0;
      }
      sum += frame_sum;
      squares += frame_squares;
      cubes += frame_cubes;
    }
    all += draws;
    std::printf("mean %g\n", mu);
    // Central moments of z: 1, 1/s, 3 + 1/mu, and for the variance of the third the sixth, 15 + 25/mu + 1/mu².
    test::expect_within_errors("mean", sum / draws, 1.0 / std::sqrt(draws));
    test::expect_within_errors("variance", squares / draws - 1.0, std::sqrt((2.0 + 1.0 / mu) / draws));
    const double sixth = 15.0 + 25.0 / mu + 1.0 / (mu * mu);
    test::expect_within_errors("third moment", cubes / draws - 1.0 / sigma, std::sqrt((sixth - 1.0 / mu) / draws));
    expect_shape(histogram, mu, draws);
    const double below = std::ceil(mu - 5.0 * sigma) - 1.0;
    expect_tail("more than 5 sigma below", low, below < 0.0 ? 0.0 : draws * poisson_cdf(below, mu));
    if (mu >= 1e-2)
      expect_tail("more than 5 sigma above", high, draws * poisson_survival(std::floor(mu + 5.0 * sigma), mu));
  }
  EXPECT_GE(all, 0.9e9);
  EXPECT_GE(kDraws, 5e7);
}

TEST(BillionDraws, OfNormalsHaveTheStandardNormalDistribution) {
  constexpr std::size_t kFrames = 4600;  // 3e8 draws
  constexpr auto kDraws = static_cast<double>(kFrames * kFrame);
  constexpr std::size_t kBins = 14001;  // of 1/1000 from -7 to 7
  const RandomStream stream = make_stream(kSeed, StreamId{9}, 0, 0);
  std::vector<float> normals(kFrame);
  std::vector<double> histogram(kBins, 0.0);
  std::array<double, 7> sums{};
  double low = 0.0;
  double high = 0.0;
  for (std::size_t f = 0; f < kFrames; ++f) {
    pixel_normals(stream, frame(f), normals);
    std::array<double, 7> frame_sums{};
    for (const float single : normals) {
      const auto z = static_cast<double>(single);
      double power = 1.0;
      for (std::size_t k = 1; k < frame_sums.size(); ++k) {
        power *= z;
        frame_sums[k] += power;
      }
      ++histogram[static_cast<std::size_t>((z + 7.0) * 1000.0)];
      low += z < -5.0 ? 1.0 : 0.0;
      high += z > 5.0 ? 1.0 : 0.0;
    }
    for (std::size_t k = 1; k < sums.size(); ++k) sums[k] += frame_sums[k];
  }
  const std::array<double, 7> exact{1.0, 0.0, 1.0, 0.0, 3.0, 0.0, 15.0};
  const std::array<double, 7> variance{0.0, 1.0, 2.0, 15.0, 96.0, 945.0, 10395.0 - 225.0};
  for (std::size_t k = 1; k < sums.size(); ++k)
    test::expect_within_errors(fmt::format("moment {}", k), sums[k] / kDraws - exact[k],
                               std::sqrt(variance[k] / kDraws));
  const auto cdf = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  std::vector<double> observed(1, 0.0);
  std::vector<double> expected;
  double below = 0.0;
  double cumulated = 0.0;
  double distance = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double up_to = cdf(-7.0 + 0.001 * static_cast<double>(bin + 1));
    cumulated += histogram[bin];
    observed.back() += histogram[bin];
    distance = std::max(distance, std::fabs(cumulated / kDraws - up_to));
    if (kDraws * (up_to - below) < 20.0 || kDraws * (1.0 - up_to) < 20.0) continue;
    expected.push_back(kDraws * (up_to - below));
    observed.push_back(0.0);
    below = up_to;
  }
  expected.push_back(kDraws * (1.0 - below));
  test::expect_chi_squared(fmt::format("chi-squared in {} bins", observed.size()), observed, expected);
  test::expect_probable("Kolmogorov-Smirnov distance * sqrt(n)", distance * std::sqrt(kDraws),
                        kolmogorov(distance * std::sqrt(kDraws)));
  const double beyond = kDraws * cdf(-5.0);
  expect_tail("below -5", low, beyond);
  expect_tail("above 5", high, beyond);
}

/// Correlations of z, z² and |z| > 3 between draws at two kinds of addresses, and their joint distribution.
void expect_independent(const std::string& what,
                        const std::function<void(std::size_t, std::vector<float>&, std::vector<float>&)>& draw) {
  constexpr std::size_t kFrames = 320;  // 2e7 pairs
  constexpr auto kPairs = static_cast<double>(kFrames * kFrame);
  constexpr std::size_t kSide = 16;
  std::vector<float> a(kFrame);
  std::vector<float> b(kFrame);
  std::array<double, kSide - 1> edges{};  // of equally probable cells
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = standard_normal(static_cast<std::uint32_t>((i + 1) << 28U));
  const auto cell = [&edges](float z) {
    return static_cast<std::size_t>(std::ranges::upper_bound(edges, static_cast<double>(z)) - edges.begin());
  };
  std::vector<double> joint(kSide * kSide, 0.0);
  double product = 0.0;
  double squares = 0.0;
  double extremes = 0.0;
  for (std::size_t f = 0; f < kFrames; ++f) {
    draw(f, a, b);
    for (std::size_t i = 0; i < kFrame; ++i) {
      const auto x = static_cast<double>(a[i]);
      const auto y = static_cast<double>(b[i]);
      product += x * y;
      squares += (x * x - 1.0) * (y * y - 1.0);
      extremes += std::fabs(x) > 3.0 && std::fabs(y) > 3.0 ? 1.0 : 0.0;
      ++joint[cell(a[i]) * kSide + cell(b[i])];
    }
  }
  test::expect_within_errors(what, product / kPairs, 1.0 / std::sqrt(kPairs));
  test::expect_within_errors(what + ", squares", squares / kPairs, 2.0 / std::sqrt(kPairs));
  test::expect_chi_squared(what + ", joint", joint, std::vector<double>(joint.size(), kPairs / (kSide * kSide)));
  const double rare = std::erfc(3.0 / std::sqrt(2.0));
  expect_tail(what + ", both beyond 3 sigma", extremes, kPairs * rare * rare);
}

TEST(BillionDraws, AreIndependentBetweenPixelsExposuresEffectsAndCameras) {
  const auto stream = [](std::uint32_t effect, std::uint32_t camera, std::uint32_t detector) {
    return make_stream(kSeed, StreamId{effect}, camera, detector);
  };
  const auto shifted = [&](PixelAddress shift) {
    return [&stream, shift](std::size_t f, std::vector<float>& a, std::vector<float>& b) {
      const PixelPlaces pixels = frame(f);
      const Rectangle moved{kArea.x0 + shift.x0, kArea.y0 + shift.y, kArea.nx, kArea.ny};
      PixelPlaces other = pixels;
      other.areas = {&moved, 1};
      other.exposure += shift.exposure;
      other.draw = shift.draw;
      pixel_normals(stream(7, 1, 0), pixels, a);
      pixel_normals(stream(7, 1, 0), other, b);
    };
  };
  const auto elsewhere = [&](std::uint32_t effect, std::uint32_t camera, std::uint32_t detector) {
    return [&stream, effect, camera, detector](std::size_t f, std::vector<float>& a, std::vector<float>& b) {
      pixel_normals(stream(7, 1, 0), frame(f), a);
      pixel_normals(stream(effect, camera, detector), frame(f), b);
    };
  };
  expect_independent("next column", shifted({.x0 = 1}));
  expect_independent("four columns on", shifted({.x0 = 4}));
  expect_independent("next row", shifted({.y = 1}));
  expect_independent("next exposure", shifted({.exposure = 1}));
  expect_independent("next draw", shifted({.draw = 1}));
  expect_independent("another effect", elsewhere(9, 1, 0));
  expect_independent("another camera", elsewhere(7, 2, 0));
  expect_independent("another detector", elsewhere(7, 1, 1));
}

}  // namespace
}  // namespace astroid
