#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "astroid/analysis/budget.hpp"
#include "astroid/pipeline/calibrate.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

PreparedRun prepare_run(const Mission& mission) {
  PreparedRun run;
  run.scene = std::make_shared<const Scene>(mission, load_field(mission));
  run.plan = std::make_shared<const Plan>(make_plan(*run.scene, read_costs(costs_file())));
  return run;
}

namespace {

/// Mean over stars: the roll makes little difference between them.
MotionCovariance mean_bin_motion(const Scene& scene, std::span<const std::size_t> stars) {
  MotionCovariance mean;
  const std::vector<StarMotion> motions = star_motions(scene, stars);
  const auto count = static_cast<double>(motions.size());
  for (const StarMotion& motion : motions) {
    mean.sxx += motion.bin.sxx / count;
    mean.sxy += motion.bin.sxy / count;
    mean.syy += motion.bin.syy / count;
  }
  return mean;
}

double faintest_of(const Scene& scene, std::span<const std::size_t> stars) {
  double faintest = std::numeric_limits<double>::infinity();
  for (const std::size_t star : stars) faintest = std::min(faintest, scene.stars()[star].electrons);
  return faintest;
}

/// Sky as the optics let it through at each target, and dark current.
std::vector<double> target_backgrounds(const Scene& scene) {
  const Mission& mission = scene.mission();
  std::vector<double> backgrounds;
  if (mission.telescope.vignetting.model == VignettingModel::kNone) return backgrounds;
  const Seconds exposure = mission.simulation.exposure_time;
  for (const std::size_t target : scene.targets())
    backgrounds.push_back((scene.stars()[target].response * (mission.field.sky_background * exposure) +
                           mission.ccd.dark_current * exposure)
                              .value());
  return backgrounds;
}

}  // namespace

Ground perfect_ground(const Scene& scene) {
  Ground ground;
  ground.stars = field_stars(scene);
  ground.model.stars = ground.stars;
  ground.model.targets = scene.targets();
  ground.model.psf = &scene.psf();
  ground.model.noise = expected_pixel_noise(scene.mission());
  ground.backgrounds = target_backgrounds(scene);
  ground.model.backgrounds = ground.backgrounds;
  // What estimators have in common is decided by the targets of the full frame, whichever pixels are computed: the same
  // weights for a star in a window, a sub-field and the full frame.
  const std::vector<std::size_t> targets = full_frame_targets(scene);
  ground.model.accuracy = scene.summary().accuracy;
  ground.model.faintest_electrons = targets.empty() ? 0.0 : faintest_of(scene, targets);
  ground.model.contamination_limit = scene.mission().analysis.uncontaminated_spr;
  const RunSetup setup = run_setup(scene.mission());
  ground.model.motion =
      motion_like_pixel_noise(mean_bin_motion(scene, targets), setup.exposures_per_bin, setup.cameras);
  ground.model.gain = scene.mission().ccd.gain;
  ground.model.bias = scene.mission().ccd.bias;
  return ground;
}

}  // namespace astroid
