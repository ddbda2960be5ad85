#include "astroid/pipeline/motion.hpp"

#include <cstddef>
#include <cstdint>

namespace astroid {

std::vector<StarMotion> target_motions(const Scene& scene) {
  const AttitudeVariance exposure = scene.attitude().variance_of_mean(1);
  const AttitudeVariance bin =
      scene.attitude().variance_of_mean(static_cast<std::int64_t>(scene.summary().exposures_per_bin));
  std::vector<StarMotion> motions;
  for (const std::size_t star : scene.targets()) {
    const AttitudeJacobian& jacobian = scene.stars()[star].motion;
    motions.push_back({.exposure = motion_covariance(jacobian, exposure), .bin = motion_covariance(jacobian, bin)});
  }
  return motions;
}

}  // namespace astroid
