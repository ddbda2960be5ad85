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

namespace {

CrossCovariance cross_covariance(const AttitudeJacobian& a, const AttitudeJacobian& b, const AttitudeVariance& v) {
  const auto product = [&v](double yaw_a, double pitch_a, double roll_a, double yaw_b, double pitch_b, double roll_b) {
    return yaw_a * yaw_b * v.yaw + pitch_a * pitch_b * v.pitch + roll_a * roll_b * v.roll;
  };
  return {.xx = product(a.dx_dyaw, a.dx_dpitch, a.dx_droll, b.dx_dyaw, b.dx_dpitch, b.dx_droll),
          .xy = product(a.dx_dyaw, a.dx_dpitch, a.dx_droll, b.dy_dyaw, b.dy_dpitch, b.dy_droll),
          .yx = product(a.dy_dyaw, a.dy_dpitch, a.dy_droll, b.dx_dyaw, b.dx_dpitch, b.dx_droll),
          .yy = product(a.dy_dyaw, a.dy_dpitch, a.dy_droll, b.dy_dyaw, b.dy_dpitch, b.dy_droll)};
}

}  // namespace

AttitudeSharing::AttitudeSharing(const PreparedRun& run) : run_(run) {
  for (const PreparedGroup& a : run.groups)
    for (const PreparedGroup& b : run.groups) {
      const AttitudeModel& attitude = a.scene->attitude();
      const Seconds lag = b.scene->mission().simulation.stagger - a.scene->mission().simulation.stagger;
      exposure_.push_back(attitude.covariance_of_mean(1, lag));
      bin_.push_back(attitude.covariance_of_mean(static_cast<std::int64_t>(a.scene->summary().exposures_per_bin), lag));
    }
}

std::vector<CrossMotion> AttitudeSharing::of_target(std::size_t target) const {
  std::vector<CrossMotion> motions;
  for (const PreparedGroup& a : run_.groups)
    for (const PreparedGroup& b : run_.groups) {
      const AttitudeJacobian& in_a = a.scene->stars()[a.targets[target]].motion;
      const AttitudeJacobian& in_b = b.scene->stars()[b.targets[target]].motion;
      const std::size_t pair = motions.size();
      motions.push_back(
          {.exposure = cross_covariance(in_a, in_b, exposure_[pair]), .bin = cross_covariance(in_a, in_b, bin_[pair])});
    }
  return motions;
}

std::vector<CrossMotion> attitude_error_motion(const PreparedRun& run,
                                               std::span<const std::vector<CorrectionStretch>> corrections,
                                               std::size_t target) {
  const std::size_t count = run.groups.size();
  const auto jacobian = [&](std::size_t g) -> const AttitudeJacobian& {
    return run.groups[g].scene->stars()[run.groups[g].targets[target]].motion;
  };
  std::vector<CrossMotion> motions(count * count);
  for (std::size_t g = 0; g < count; ++g) {
    const AttitudeCorrection& correction = *corrections[g].front().correction;
    const AttitudeCovariance& error = correction.error();
    if (correction.is_measured()) {
      const MotionCovariance own = motion_covariance(jacobian(g), error);
      motions[g * count + g].exposure = {.xx = own.sxx, .xy = own.sxy, .yx = own.sxy, .yy = own.syy};
      continue;
    }
    const AttitudeVariance shared{error.yaw_yaw, error.pitch_pitch, error.roll_roll};
    for (std::size_t h = 0; h < count; ++h)
      motions[g * count + h].exposure = cross_covariance(jacobian(g), jacobian(h), shared);
  }
  return motions;
}

}  // namespace astroid
