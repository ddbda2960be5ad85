// The mean over groups of cameras that see a star differently: one estimator, truth and noise for their mean light
// curve.
//
// Every camera's relative deviation from its own reference counts the same, so a group counts by its share of the
// cameras. What cameras have of their own averages within and between groups; the attitude is common to all, though
// it moves a star along another direction in each group, and at another time where exposures are staggered (F112).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/analysis/motion.hpp"
#include "astroid/analysis/target_metrics.hpp"
#include "astroid/analysis/truth.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// One star as the cameras of one group see it.
struct GroupView {
  const StarEstimator* estimator = nullptr;
  double share = 1.0;  ///< of the group in all cameras; all together 1
};

/// What the mean light curve is, as the estimator of one camera would be: the mean reference, target, contaminants and
/// flags, and such variances that divided by the number of cameras they are those of the mean. Place, mask and window
/// are those of the first group; terms and gradients are left out. One group alone is its estimator, to the bit.
StarEstimator mean_estimator(std::span<const GroupView> groups);

/// Place and magnitude of the first group, electrons of the mean.
TruthStar mean_truth(std::span<const TruthStar> groups, std::span<const double> shares);

/// Noise of the mean light curve by motion.
/// @param motions  [group][group], row by row: how a star moves in one group with how it moves in another.
MotionNoise mean_motion_noise(std::span<const GroupView> groups, std::span<const CrossMotion> motions,
                              const RunSetup& setup);

}  // namespace astroid
