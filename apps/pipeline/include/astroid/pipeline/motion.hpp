// How stars move, from the scene's attitude.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/analysis/motion.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// Covariance of each star's displacement, of one exposure's mean and of the mean over a bin.
/// @param stars  indices into scene.stars().
std::vector<StarMotion> star_motions(const Scene& scene, std::span<const std::size_t> stars);

/// The same of each target. @returns shape (scene.targets())
std::vector<StarMotion> target_motions(const Scene& scene);

}  // namespace astroid
