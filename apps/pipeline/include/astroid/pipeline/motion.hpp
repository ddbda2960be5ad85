// How each target moves, from the scene's attitude.
#pragma once

#include <vector>

#include "astroid/analysis/motion.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Covariance of each target's displacement, of one exposure's mean and of the mean over a bin.
/// @returns shape (scene.targets())
std::vector<StarMotion> target_motions(const Scene& scene);

}  // namespace astroid
