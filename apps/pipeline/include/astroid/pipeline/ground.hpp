// What the ground believes, and the estimators it builds from that.
#pragma once

#include <vector>

#include "astroid/photometry/estimator.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// The believed field of a scene; owns what GroundModel points to.
struct Ground {
  std::vector<FieldStar> stars;
  std::vector<double> backgrounds;  ///< e- per pixel at each target; empty where it is the same everywhere
  GroundModel model;
};

/// A ground that knows the stars, the PSF, the mean background, the detector and the statistics of the jitter exactly.
/// @param scene  must outlive the result.
Ground perfect_ground(const Scene& scene);

}  // namespace astroid
