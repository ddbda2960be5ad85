// Common trends of an ensemble: found where they are, and not where they are not.
#include "astroid/photometry/cotrending.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr std::size_t kBins = 168;
constexpr double kNoise = 50e-6;

struct Ensemble {
  std::vector<float> series;
  std::vector<double> noise;
  std::vector<double> first, second;  // amplitude of two trends in each star
  explicit Ensemble(std::size_t stars, double amplitude, std::uint32_t seed) {
    const test::TestNoise random(seed);
    for (std::uint32_t s = 0; s < stars; ++s) {
      first.push_back(amplitude * random.normal(s, 0));
      second.push_back(0.3 * amplitude * random.normal(s, 1));
      noise.push_back(kNoise * (1.0 + random.uniform(s, 2)));
      for (std::uint32_t b = 0; b < kBins; ++b) {
        const double phase = static_cast<double>(b) / kBins;
        series.push_back(static_cast<float>(first.back() * (phase - 0.5) + second.back() * det::sin(6.0 * kPi * phase) +
                                            noise.back() * random.normal(s, 10 + b)));
      }
    }
  }
  [[nodiscard]] std::span<const float> star(std::size_t s) const { return std::span(series).subspan(s * kBins, kBins); }
};

TEST(Cotrending, FindsNothingInNoise) {
  int found = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const std::size_t stars = seed % 2 == 0 ? 100 : 250;  // fewer and more than there are bins
    const Ensemble ensemble(stars, 0.0, seed);
    const CommonTrends trends(ensemble.series, ensemble.noise, kBins, 4);
    EXPECT_EQ(trends.references(), stars);
    found += static_cast<int>(trends.trends());
    const TrendFit fit = trends.fit(ensemble.star(0));
    EXPECT_DOUBLE_EQ(fit.rms_after, fit.rms_before) << "without trends a series stays what it was";
  }
  EXPECT_EQ(found, 0);
}

TEST(Cotrending, LeavesTheNoiseOfEachStar) {
  for (const std::size_t stars : {std::size_t{150}, std::size_t{200}}) {  // fewer and more than there are bins
    const Ensemble ensemble(stars, 400e-6, 5);
    const CommonTrends trends(ensemble.series, ensemble.noise, kBins, 8);
    ASSERT_EQ(trends.trends(), 2U);
    double before = 0.0;
    double after = 0.0;
    for (std::size_t s = 0; s < stars; ++s) {
      const TrendFit fit = trends.fit(ensemble.star(s));
      before += fit.rms_before / ensemble.noise[s] / static_cast<double>(stars);
      after += fit.rms_after / ensemble.noise[s] / static_cast<double>(stars);
    }
    std::cout << "scatter over noise: " << before << " before, " << after << " after\n";
    EXPECT_GT(before, 1.5);
    // Each rms is known to 1/sqrt(2 (168 - 3)) = 5.5 %, so their mean to 0.45 %. Noise of the references in the trends
    // adds 1/150 of a variance; what a star has of its own noise in them takes as much away.
    EXPECT_NEAR(after, 1.0, 0.015);
  }
}

TEST(Cotrending, KeepsASignalThatOneStarHasAlone) {
  Ensemble ensemble(150, 400e-6, 7);
  constexpr double kDepth = 500e-6;
  for (std::size_t b = 80; b < 84; ++b) ensemble.series[3 * kBins + b] -= static_cast<float>(kDepth);
  const CommonTrends trends(ensemble.series, ensemble.noise, kBins, 8);
  const TrendFit fit = trends.fit(ensemble.star(3));
  double inside = 0.0;
  double outside = 0.0;
  for (std::size_t b = 60; b < 104; ++b) {
    const double left = static_cast<double>(ensemble.star(3)[b]) - trends.at(fit, b);
    (b >= 80 && b < 84 ? inside : outside) += left / (b >= 80 && b < 84 ? 4.0 : 40.0);
  }
  const double error = ensemble.noise[3] * std::sqrt(1.0 / 4.0 + 1.0 / 40.0);
  EXPECT_NEAR(outside - inside, kDepth, 3.5 * error) << "sigma " << error;
}

TEST(Cotrending, BearsGapsAndTooLittle) {
  Ensemble ensemble(100, 400e-6, 9);
  ensemble.series[5 * kBins + 7] = std::numeric_limits<float>::quiet_NaN();
  const CommonTrends trends(ensemble.series, ensemble.noise, kBins, 8);
  EXPECT_EQ(trends.references(), 99U);
  const TrendFit fit = trends.fit(ensemble.star(5));
  EXPECT_NEAR(fit.rms_after, ensemble.noise[5], 4.0 * ensemble.noise[5] / std::sqrt(2.0 * kBins));
  const std::vector<float> empty(kBins, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(std::isnan(trends.fit(empty).rms_before));
  EXPECT_EQ(CommonTrends(std::span(ensemble.series).first(kBins), {&ensemble.noise[0], 1}, kBins, 3).trends(), 0U)
      << "nothing is common to one star";
  EXPECT_EQ(CommonTrends({}, ensemble.noise, 0, 3).trends(), 0U);
}

}  // namespace
}  // namespace astroid
