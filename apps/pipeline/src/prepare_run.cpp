#include "astroid/analysis/budget.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

PreparedRun prepare_run(const Mission& mission) {
  PreparedRun run;
  run.scene = std::make_shared<const Scene>(mission, load_field(mission));
  run.plan = std::make_shared<const Plan>(make_plan(*run.scene));
  return run;
}

namespace {

/// Mean over the targets: the roll makes little difference between them.
MotionCovariance mean_bin_motion(const Scene& scene) {
  MotionCovariance mean;
  const std::vector<StarMotion> motions = target_motions(scene);
  const auto count = static_cast<double>(motions.size());
  for (const StarMotion& motion : motions) {
    mean.sxx += motion.bin.sxx / count;
    mean.sxy += motion.bin.sxy / count;
    mean.syy += motion.bin.syy / count;
  }
  return mean;
}

}  // namespace

Ground perfect_ground(const Scene& scene) {
  Ground ground;
  ground.stars = field_stars(scene);
  ground.model.stars = ground.stars;
  ground.model.targets = scene.targets();
  ground.model.psf = &scene.psf();
  ground.model.noise = expected_pixel_noise(scene.mission());
  ground.model.accuracy = scene.summary().accuracy;
  ground.model.contamination_limit = scene.mission().analysis.uncontaminated_spr;
  const RunSetup setup = run_setup(scene.mission());
  ground.model.motion = motion_like_pixel_noise(mean_bin_motion(scene), setup.exposures_per_bin, setup.cameras);
  ground.model.gain = scene.mission().ccd.gain;
  ground.model.bias = scene.mission().ccd.bias;
  return ground;
}

}  // namespace astroid
