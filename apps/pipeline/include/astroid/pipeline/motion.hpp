// How stars move, from the scene's attitude.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/analysis/motion.hpp"
#include "astroid/pipeline/attitude_correction.hpp"
#include "astroid/pipeline/run.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Covariance of each star's displacement, of one exposure's mean and of the mean over a bin.
/// @param stars  indices into scene.stars().
std::vector<StarMotion> star_motions(const Scene& scene, std::span<const std::size_t> stars);

/// The same of each target. @returns shape (scene.targets())
std::vector<StarMotion> target_motions(const Scene& scene);

/// What cameras that read out at different times share of the attitude.
class AttitudeSharing {
 public:
  /// @param run  must outlive this.
  explicit AttitudeSharing(const PreparedRun& run);
  /// How a target moves in the cameras of every group with how it moves in those of every other.
  /// @returns shape (groups, groups), row by row
  [[nodiscard]] std::vector<CrossMotion> of_target(std::size_t target) const;

 private:
  const PreparedRun& run_;
  std::vector<AttitudeVariance> exposure_, bin_;  // [group][group], covariances
};

/// The error of the attitude that jitter correction uses, as a motion of a target; nothing of it averages out within an
/// exposure. Shape as of_target(): what cameras of different groups share is theirs only where the spacecraft tells it.
/// @param corrections  of each group, none of them empty; the first stretch of each is taken for all.
std::vector<CrossMotion> attitude_error_motion(const PreparedRun& run,
                                               std::span<const std::vector<CorrectionStretch>> corrections,
                                               std::size_t target);

}  // namespace astroid
