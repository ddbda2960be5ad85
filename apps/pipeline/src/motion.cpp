#include "astroid/pipeline/motion.hpp"

#include <cstdint>

namespace astroid {

std::vector<StarMotion> star_motions(const Scene& scene, std::span<const std::size_t> stars) {
  const AttitudeVariance exposure = scene.attitude().variance_of_mean(1);
  const AttitudeVariance bin =
      scene.attitude().variance_of_mean(static_cast<std::int64_t>(scene.summary().exposures_per_bin));
  std::vector<StarMotion> motions;
  motions.reserve(stars.size());
  for (const std::size_t star : stars) {
    const AttitudeJacobian& jacobian = scene.stars()[star].motion;
    motions.push_back({.exposure = motion_covariance(jacobian, exposure), .bin = motion_covariance(jacobian, bin)});
  }
  return motions;
}

std::vector<StarMotion> target_motions(const Scene& scene) {
  return star_motions(scene, scene.targets());
}

}  // namespace astroid
