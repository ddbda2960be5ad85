#include "astroid/analysis/recovery.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "astroid/test/synthetic_targets.hpp"

namespace astroid {
namespace {

using test::plato_setup;
using test::synthetic_targets;

TEST(MagnitudeRecovery, CountsEveryStarOnceAndInItsBin) {
  const auto targets = synthetic_targets({.stars = 500});
  std::int64_t stars = 0;
  for (const RecoveryBin& bin : magnitude_recovery(targets, plato_setup())) {
    stars += bin.stars;
    EXPECT_NEAR(bin.mag_high - bin.mag_low, kMagnitudeBin, 1e-12);
    EXPECT_LE(bin.uncontaminated, bin.clean);
    EXPECT_LE(bin.clean + bin.saturated, bin.stars);
  }
  EXPECT_EQ(stars, 500);
}

TEST(MagnitudeRecovery, FindsNoBiasWhereThereIsNone) {
  const auto targets = synthetic_targets({.stars = 3000, .seed = 5});
  const RecoverySummary summary = recovery_summary(targets, plato_setup());
  EXPECT_GT(summary.stars, 500);
  EXPECT_LT(std::abs(summary.bias), 4.0 * summary.bias_err);
  EXPECT_NEAR(summary.pull_width, 1.0, 4.0 / std::sqrt(2.0 * static_cast<double>(summary.stars)));
}

TEST(MagnitudeRecovery, FindsTheBiasThatWasPutIn) {
  const auto targets = synthetic_targets({.stars = 3000, .flux_factor = 0.99, .seed = 6});
  const RecoverySummary summary = recovery_summary(targets, plato_setup());
  EXPECT_NEAR(summary.bias, 0.01 * 1.0857, 4.0 * summary.bias_err);
  EXPECT_GT(summary.bias, 20.0 * summary.bias_err);
}

TEST(MagnitudeRecovery, ExpectsTheScatterItSees) {
  const auto targets = synthetic_targets({.stars = 4000, .seed = 7});
  for (const RecoveryBin& bin : magnitude_recovery(targets, plato_setup())) {
    if (bin.uncontaminated < 100) continue;
    const double relative = 4.0 / std::sqrt(2.0 * static_cast<double>(bin.uncontaminated));
    EXPECT_NEAR(bin.residual.scatter / bin.expected_scatter, 1.0, relative) << bin.mag_low;
    EXPECT_NEAR(bin.pull_width, 1.0, relative) << bin.mag_low;
  }
}

TEST(MagnitudeRecovery, LeavesSaturatedStarsOutOfTheBias) {
  const auto targets = synthetic_targets({.stars = 1000, .seed = 8});
  for (const RecoveryBin& bin : magnitude_recovery(targets, plato_setup())) {
    if (bin.mag_high <= 7.0) {
      EXPECT_EQ(bin.saturated, bin.stars);
      EXPECT_TRUE(std::isnan(bin.residual.value));
    }
  }
}

TEST(MagnitudeRecovery, CountsStarsWithoutPositiveFlux) {
  auto targets = synthetic_targets({.stars = 20});
  targets[3].flux_measured = -1.0;
  targets[3].mag_measured = targets[3].delta_mag = targets[3].causes.residual = std::nan("");
  std::int64_t not_positive = 0;
  for (const RecoveryBin& bin : magnitude_recovery(targets, plato_setup())) not_positive += bin.not_positive;
  EXPECT_EQ(not_positive, 1);
}

TEST(FaintStarBias, IsJudgedInFluxOnTheFaintestMagnitude) {
  const auto targets = synthetic_targets({.stars = 4000, .seed = 9});
  const FaintBias fair = faint_star_bias(targets, plato_setup());
  EXPECT_NEAR(fair.mag_from, 13.0, 0.05);
  EXPECT_LT(std::abs(fair.z()), 4.0);
  const auto floored = synthetic_targets({.stars = 4000, .flux_factor = 0.98, .seed = 9});
  EXPECT_LT(faint_star_bias(floored, plato_setup()).z(), -10.0);
}

TEST(FaintStarBias, IsUnknownWithoutStars) {
  EXPECT_TRUE(std::isnan(faint_star_bias({}, plato_setup()).mag_from));
}

}  // namespace
}  // namespace astroid
