#include "astroid/analysis/noise_vs_magnitude.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/analysis/verdict.hpp"
#include "astroid/test/synthetic_targets.hpp"

namespace astroid {
namespace {

using test::plato_setup;
using test::synthetic_targets;
using ::testing::HasSubstr;

TEST(NoiseVsMagnitude, FindsThePredictedNoiseWithFewAndWithManyBins) {
  // The median of a deviation from one degree of freedom lies 15 % below its mean: the ratio must not.
  for (const std::int64_t bins : {2, 5, 24, 168}) {
    const auto targets = synthetic_targets({.stars = 4000, .bins = bins, .seed = 20});
    const NoiseSummary summary = noise_summary(targets);
    EXPECT_EQ(summary.within, bins < 10);
    EXPECT_NEAR(summary.ratio.value, 1.0, 1.5 * summary.ratio.half_width()) << bins;
  }
}

TEST(NoiseVsMagnitude, FindsTheExcessThatWasPutIn) {
  const auto targets = synthetic_targets({.stars = 4000, .noise_factor = 1.1, .seed = 21});
  const NoiseSummary summary = noise_summary(targets);
  EXPECT_NEAR(summary.ratio.value, 1.1, 1.5 * summary.ratio.half_width());
  EXPECT_GT(summary.ratio.low, 1.05);
}

TEST(NoiseVsMagnitude, LeavesSaturatedStarsOut) {
  const auto targets = synthetic_targets({.stars = 1000, .seed = 22});
  const auto bins = noise_vs_magnitude(targets);
  std::int64_t stars = 0;
  for (const NoiseBin& bin : bins) stars += bin.stars;
  std::int64_t clean = 0;
  for (const TargetMetrics& target : targets) clean += is_clean(target) ? 1 : 0;
  EXPECT_EQ(stars, clean);
  EXPECT_GE(bins.front().mag_high, 7.5);
}

TEST(NoiseVsMagnitude, RisesWithMagnitudeAndExceedsEveryCause) {
  const auto bins = noise_vs_magnitude(synthetic_targets({.stars = 4000, .seed = 23}));
  double last = 0.0;
  for (const NoiseBin& bin : bins) {
    EXPECT_GT(bin.predicted_ppm, last);
    EXPECT_GT(bin.predicted_ppm, bin.causes.photon);
    EXPECT_GT(bin.predicted_ppm, bin.causes.readout);
    last = bin.predicted_ppm;
  }
}

TEST(NoiseAtMagnitude, LiesOnThePredictedLine) {
  const auto targets = synthetic_targets({.stars = 4000, .bins = 168, .seed = 24});
  const auto noise = noise_at_magnitude(targets, 11.0);
  ASSERT_TRUE(noise.has_value());
  EXPECT_TRUE(noise->measured);
  const auto bins = noise_vs_magnitude(targets, 0.1);
  for (const NoiseBin& bin : bins) {
    if (std::abs(bin.mag_median - 11.0) > 0.05) continue;
    EXPECT_NEAR(noise->ppm, bin.predicted_ppm, 0.03 * bin.predicted_ppm);
  }
  EXPECT_LT(noise->high - noise->low, 0.03 * noise->ppm);
}

TEST(NoiseAtMagnitude, IsUnknownWithFewerThanFiveStars) {
  EXPECT_FALSE(noise_at_magnitude(synthetic_targets({.stars = 4}), 13.0).has_value());
}

TEST(NoiseAtMagnitude, IsPredictedWhereNothingWasMeasured) {
  auto targets = synthetic_targets({.stars = 200, .seed = 25});
  for (TargetMetrics& target : targets) {
    target.nsr_1h_measured = target.nsr_1h_within_measured = target.nsr_1h_scaled = target.nsr_1h_within_scaled = {};
  }
  const auto noise = noise_at_magnitude(targets, 12.0);
  ASSERT_TRUE(noise.has_value());
  EXPECT_FALSE(noise->measured);
}

TEST(Requirement, OfPlatoGoesWithTheRootOfTheCameras) {
  EXPECT_DOUBLE_EQ(plato_requirement(24).ppm, 50.0);
  EXPECT_DOUBLE_EQ(plato_requirement(6).ppm, 100.0);
  EXPECT_NEAR(plato_requirement(12).ppm, 70.7, 0.05);
  EXPECT_NEAR(plato_requirement(18).ppm, 57.7, 0.05);
  EXPECT_DOUBLE_EQ(plato_requirement(24, 4.0).ppm, 25.0);
}

TEST(Compliance, CountsTargetsWithinTheMagnitude) {
  const auto targets = synthetic_targets({.stars = 2000, .bins = 168, .seed = 26});
  const Compliance all = compliance(targets, {"lax", 11.0, 1000.0});
  EXPECT_GT(all.targets, 50);
  EXPECT_EQ(all.predicted, all.targets);
  EXPECT_EQ(all.measured, all.targets);
  EXPECT_EQ(compliance(targets, {"strict", 11.0, 1.0}).measured, 0);
}

TEST(Verdict, SaysInTwoLinesWhatWasFound) {
  const auto targets = synthetic_targets({.stars = 2000, .bins = 168, .seed = 27});
  const auto lines = verdict(targets, plato_setup(), 1.0, plato_requirement(24));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines[0], HasSubstr("unsaturated targets, mag 7."));
  EXPECT_THAT(lines[0], HasSubstr("of predicted (median); bias of uncontaminated stars"));
  EXPECT_THAT(lines[0], HasSubstr(" mmag"));
  EXPECT_THAT(lines[1], HasSubstr("noise at mag 11 in 1 h with 24 cameras: "));
  EXPECT_THAT(lines[1], HasSubstr("requirement 50 ppm: "));
}

TEST(Verdict, SaysWhatIsNotKnown) {
  const auto lines = verdict({}, plato_setup(), 1.0, plato_requirement(24));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "no unsaturated target: nothing to compare");
  EXPECT_THAT(lines[1], HasSubstr("not known, fewer than 5 unsaturated targets within 1 mag"));
}

TEST(Verdict, NamesAnExcessOverTheRequirement) {
  const auto targets = synthetic_targets({.stars = 2000, .bins = 168, .noise_factor = 3.0, .seed = 28});
  EXPECT_THAT(verdict(targets, plato_setup(), 1.0, plato_requirement(24))[1], HasSubstr("requirement 50 ppm: not met"));
}

}  // namespace
}  // namespace astroid
