// The mean of groups is what the sum of their parts says: own noise averages, common motion adds up.
#include "astroid/analysis/group_mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/test/synthetic_targets.hpp"

namespace astroid {
namespace {

TEST(GroupMean, OfOneGroupIsItsEstimatorToTheBit) {
  StarEstimator e = test::synthetic_estimator(1e5, 1e3, 9, 0.9);
  e.flags = 8;
  const std::vector<GroupView> one{{&e, 1.0}};
  const StarEstimator mean = mean_estimator(one);
  EXPECT_EQ(mean.budget.target, e.budget.target);
  EXPECT_EQ(mean.budget.variance(), e.budget.variance());
  EXPECT_EQ(mean.enclosed_fraction, e.enclosed_fraction);
  EXPECT_EQ(mean.spr_total, e.spr_total);
  EXPECT_EQ(mean.flags, e.flags);
}

TEST(GroupMean, OfEqualGroupsIsOneOfThem) {
  const StarEstimator e = test::synthetic_estimator(1e5, 1e3, 9, 0.9);
  const std::vector<GroupView> views{{&e, 0.25}, {&e, 0.75}};
  const StarEstimator mean = mean_estimator(views);
  EXPECT_NEAR(mean.budget.target, e.budget.target, 1e-9 * e.budget.target);
  EXPECT_NEAR(mean.budget.variance(), e.budget.variance(), 1e-9 * e.budget.variance());
  EXPECT_NEAR(mean.enclosed_fraction, e.enclosed_fraction, 1e-12);
  EXPECT_NEAR(mean.spr_total, e.spr_total, 1e-12);
}

TEST(GroupMean, HasTheVarianceOfTheMeanOfRelativeDeviations) {
  const StarEstimator bright = test::synthetic_estimator(1e5, 0.0, 9, 0.9);
  const StarEstimator dim = test::synthetic_estimator(6e4, 5e3, 9, 0.9);
  const std::vector<GroupView> views{{&bright, 2.0 / 3.0}, {&dim, 1.0 / 3.0}};
  RunSetup setup = test::plato_setup();
  setup.cameras = setup.simulated_cameras = 6;
  setup.prnu = 0.0;
  const StarEstimator mean = mean_estimator(views);
  const PredictedNoise noise = predict_mean_noise(mean, {}, setup);
  const auto relative = [](const StarEstimator& e) {
    const double all = e.budget.target + e.budget.contaminants;
    return e.budget.variance() / (all * all);
  };
  // Four cameras of the one and two of the other, each a sixth of the mean; relative to the target's share of the
  // light.
  const double variance = (4.0 * relative(bright) + 2.0 * relative(dim)) / 36.0 / setup.exposures_per_bin;
  const double share = (2.0 * (1.0 - bright.spr_total) + (1.0 - dim.spr_total)) / 3.0;
  EXPECT_NEAR(noise.bin.total(), 1e6 * std::sqrt(variance) / share, 1e-9 * noise.bin.total());
  EXPECT_NEAR(noise.bin_simulated, noise.bin.total(), 1e-9 * noise.bin.total());
}

TEST(GroupMean, CancelsMotionThatIsOppositeAndKeepsWhatIsAlike) {
  StarEstimator e = test::synthetic_estimator(1e5, 0.0, 9, 0.9);
  e.gradient_x = 0.1;
  const std::vector<GroupView> views{{&e, 0.5}, {&e, 0.5}};
  const CrossMotion own{.exposure = {.xx = 1e-4}, .bin = {.xx = 1e-5}};
  const CrossMotion opposite{.exposure = {.xx = -1e-4}, .bin = {.xx = -1e-5}};
  const RunSetup setup = test::plato_setup();
  const MotionNoise alike = mean_motion_noise(views, std::vector<CrossMotion>{own, own, own, own}, setup);
  EXPECT_NEAR(alike.jitter_exposure, 1e-6, 1e-15);
  EXPECT_NEAR(alike.jitter_bin, 1e-7, 1e-16);
  const MotionNoise none = mean_motion_noise(views, std::vector<CrossMotion>{own, opposite, opposite, own}, setup);
  EXPECT_NEAR(none.jitter_exposure, 0.0, 1e-15);
  EXPECT_NEAR(none.jitter_camera, 1e-6, 1e-15);
  // Apart from each other in time or direction: half of it is common.
  const MotionNoise apart = mean_motion_noise(views, std::vector<CrossMotion>{own, {}, {}, own}, setup);
  EXPECT_NEAR(apart.jitter_bin, 0.5e-7, 1e-16);
}

}  // namespace
}  // namespace astroid
