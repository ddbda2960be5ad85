#include "mesh/light_under_sky.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

using detail::LightUnderSky;
using Bins = std::array<double, LightUnderSky::kBins>;

void count(Bins& bins, double value) {
  const double t = (value + LightUnderSky::kReach) / LightUnderSky::kStep;
  if (t >= 0.0 && t < static_cast<double>(bins.size())) bins[static_cast<std::size_t>(t)] += 1.0;
}

constexpr std::uint32_t kPixels = 200000;

TEST(LightUnderSky, FindsTheLevelUnderLightOfItsKind) {
  const test::TestNoise noise(21);
  for (const double lit : {0.0, 0.1, 0.5}) {
    Bins bins{};
    for (std::uint32_t i = 0; i < kPixels; ++i) {
      double v = -0.2 + 0.9 * noise.normal(0, i);
      // Density 1/light from 0.02 to 4.
      if (noise.uniform(1, i) < lit) v += 0.9 * 0.02 * std::pow(200.0, noise.uniform(2, i));
      count(bins, v);
    }
    const LightUnderSky::Fit fit = LightUnderSky(0.0, 0.0).fit(bins);
    ASSERT_TRUE(fit.converged);
    EXPECT_NEAR(fit.level, -0.2, 4.0 * fit.error) << lit;
    EXPECT_LT(fit.error, 0.01);
    EXPECT_NEAR(fit.sigma, 0.9, 0.02) << lit;
    EXPECT_NEAR(fit.lit, lit, 0.03) << lit;
  }
}

TEST(LightUnderSky, KnowsThatPhotonsAreSkewed) {
  const test::TestNoise noise(22);
  Bins bins{};
  // A Poisson variable of mean 100 in units of its sigma, from its Cornish-Fisher expansion, skewness 0.1.
  constexpr double kSkewness = 0.1;
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    const double z = noise.normal(3, i);
    count(bins, z + kSkewness / 6.0 * (z * z - 1.0));
  }
  const LightUnderSky::Fit fit = LightUnderSky(kSkewness, 0.0).fit(bins);
  ASSERT_TRUE(fit.converged);
  EXPECT_NEAR(fit.level, 0.0, 4.0 * fit.error + 0.003);
}

TEST(LightUnderSky, DoesNotFitWhatIsDistributedOtherwise) {
  const test::TestNoise noise(23);
  Bins flat{};
  for (std::uint32_t i = 0; i < kPixels; ++i) count(flat, 3.4 * noise.uniform(4, i) - 1.7);
  EXPECT_FALSE(LightUnderSky(0.0, 0.0).fit(flat).converged);
  EXPECT_FALSE(LightUnderSky(0.0, 0.0).fit(Bins{}).converged);
}

}  // namespace
}  // namespace astroid
