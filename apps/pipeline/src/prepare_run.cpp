#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "astroid/analysis/budget.hpp"
#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/camera_groups.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/throughput.hpp"
#include "astroid/pipeline/calibrate.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/pipeline/run.hpp"
#include "astroid/sim/aberration.hpp"
#include "astroid/sim/attitude_trend.hpp"
#include "astroid/sim/smearing.hpp"

namespace astroid {

namespace {

/// Keeps the stars that are targets in every group, in the order of the first.
void find_common_targets(PreparedRun& run) {
  if (run.groups.size() == 1) {
    const std::span<const std::size_t> all = run.scene().targets();
    run.groups.front().targets.assign(all.begin(), all.end());
    return;
  }
  std::unordered_map<std::string, std::size_t> seen;  // by how many groups
  for (const PreparedGroup& group : run.groups)
    for (const std::size_t target : group.scene->targets()) ++seen[group.scene->stars()[target].id];
  std::vector<std::string> common;
  for (const std::size_t target : run.scene().targets()) {
    const std::string& id = run.scene().stars()[target].id;
    if (seen[id] == run.groups.size()) common.push_back(id);
  }
  for (PreparedGroup& group : run.groups) {
    std::unordered_map<std::string, std::size_t> number;
    for (const std::size_t target : group.scene->targets()) number[group.scene->stars()[target].id] = target;
    for (const std::string& id : common) group.targets.push_back(number.at(id));
  }
  if (common.size() < seen.size())
    run.notes.push_back(fmt::format("{} of {} stars are targets in some groups of cameras only, and left out",
                                    seen.size() - common.size(), seen.size()));
}

/// Notes of the scenes, once where all have them.
void collect_notes(PreparedRun& run) {
  const auto all_have = [&](const std::string& note) {
    return std::ranges::all_of(run.groups, [&](const PreparedGroup& group) {
      return std::ranges::find(group.scene->notes(), note) != group.scene->notes().end();
    });
  };
  for (std::size_t g = 0; g < run.groups.size(); ++g)
    for (const std::string& note : run.groups[g].scene->notes()) {
      const bool is_common = all_have(note);
      if (is_common && g == 0) run.notes.push_back(note);
      if (!is_common) run.notes.push_back(fmt::format("group {}: {}", g + 1, note));
    }
}

}  // namespace

PreparedRun prepare_run(const Mission& mission) {
  return prepare_run(mission, load_field(mission));
}

PreparedRun prepare_run(const Mission& mission, const StarCatalogue& catalogue) {
  const CostFactors costs = read_costs(costs_file());
  const bool has_groups = mission.telescope.group < 0 && !mission.telescope.groups.cameras.empty();
  const int count = has_groups ? group_count(mission.telescope) : 1;
  PreparedRun run;
  int steps = 1;  // of all: cameras that see the same random path must ask for it at the same instants
  for (int g = 0; g < count; ++g) {
    PreparedGroup group;
    group.scene = std::make_shared<const Scene>(has_groups ? group_mission(mission, g) : mission, catalogue);
    group.plan = std::make_shared<const Plan>(make_plan(*group.scene, costs));
    if (has_groups) group.share = group_share(mission.telescope, g);
    steps = std::max(steps, group.plan->knobs.attitude_steps);
    run.groups.push_back(std::move(group));
  }
  for (PreparedGroup& group : run.groups)
    if (group.plan->knobs.attitude_steps < steps)
      group.plan = std::make_shared<const Plan>(make_plan(*group.scene, costs, steps));
  collect_notes(run);
  find_common_targets(run);
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
std::vector<double> target_backgrounds(const Scene& scene, std::span<const std::size_t> targets) {
  const Mission& mission = scene.mission();
  std::vector<double> backgrounds;
  const double passed = mean_throughput(mission);  // which the light has, and the response too
  if (mission.telescope.vignetting.model == VignettingModel::kNone || !(passed > 0.0)) return backgrounds;
  const ElectronsPerSecond light = mean_background_rate(mission);
  for (const std::size_t target : targets)
    backgrounds.push_back(expected_pixel_noise(mission, scene.stars()[target].response / passed * light).background);
  return backgrounds;
}

void believe_readout(const Scene& scene, GroundModel& model) {
  const CcdSettings& ccd = scene.mission().ccd;
  const FrameCalibration calibration(*scene.layout(), calibration_model(scene.mission()));
  model.smearing.electrons = smeared_electrons(scene);
  if (const ReadoutNodes nodes = readout_nodes(scene); nodes.splits_columns()) {
    model.smearing.upper = smeared_electrons(scene, 1);
    model.smearing.upper_row = nodes.middle_y();
  }
  model.smearing.overscan_rows = calibration.overscan_rows();
  model.bias_variance = calibration.bias_variance();
  model.bias_is_measured = scene.mission().photometry.calibration.bias == BiasSource::kPrescan;
  const double row_offset = ccd.electronics.row_offset * ccd.gain.value();
  model.row_offset_variance = row_offset * row_offset;
  model.pick_up = ccd.electronics.pick_up.amplitude * ccd.gain.value();
  model.pick_up_column_frequency = ccd.electronics.pick_up.column_frequency;
  model.pick_up_row_frequency = ccd.electronics.pick_up.row_frequency;
  model.nodes = ReadoutNodes(scene.detector(), ccd.nodes.count);
  const double variance = ccd.readout_noise.value() * ccd.readout_noise.value();
  for (std::size_t node = 0; node < ccd.nodes.noise_factor.size(); ++node) {
    const double factor = ccd.nodes.noise_factor[node];
    model.more_readout_variance[node] = variance * (factor * factor - 1.0);
  }
}

}  // namespace

std::shared_ptr<const PixelPsf> psf_in_images(const Scene& scene) {
  return imaged_psf(scene.mission(), {std::shared_ptr<const void>(), &scene.psf()});
}

CalibrationModel calibration_model(const Mission& mission) {
  const CcdSettings& ccd = mission.ccd;
  const CalibrationSettings& calibration = mission.photometry.calibration;
  CalibrationModel model;
  model.detector = {0, 0, ccd.columns, ccd.rows};
  model.nodes = ccd.nodes.count;
  model.gain = ccd.gain;
  model.bias = ccd.bias;
  double noisiest = 1.0;
  for (const double factor : ccd.nodes.noise_factor) noisiest = std::max(noisiest, factor);
  model.readout_noise = noisiest * ccd.readout_noise;
  model.measure_bias = calibration.bias == BiasSource::kPrescan;
  model.subtract_smearing = calibration.smearing;
  if (calibration.nonlinearity) {
    const std::vector<double>& believed = calibration.nonlinearity_coefficients;
    model.response = make_response(believed.empty() ? ccd.electronics.nonlinearity : believed);
  }
  if (calibration.gain) std::ranges::copy(ccd.nodes.gain_factor, model.gain_factors.begin());
  return model;
}

Ground perfect_ground(const Scene& scene) {
  return perfect_ground(scene, scene.targets());
}

namespace {

/// Exposures between two refreshes of the masks; 0 where they are made once, or nothing leads the stars away.
std::int64_t exposures_per_refresh(const Scene& scene) {
  const Mission& mission = scene.mission();
  const double refresh = mission.photometry.mask_refresh.value();
  if (!(refresh > 0.0) || (scene.attitude_trend().is_still() && !mission.satellite.aberration)) return 0;
  return std::max<std::int64_t>(1, std::llround(refresh / mission.simulation.cycle.value()));
}

/// The attitude of an exposure but for jitter.
Attitude trend_at(const Scene& scene, std::int64_t exposure) {
  const double start = static_cast<double>(exposure) * scene.mission().simulation.cycle.value();
  return scene.attitude_trend().at(scene.mid_time(exposure).value(), start);
}

/// The stars where they are in an exposure, but for jitter.
std::vector<FieldStar> stars_at(const Scene& scene, std::int64_t exposure) {
  const SimulationSettings& simulation = scene.mission().simulation;
  const Seconds time = scene.mid_time(exposure);
  const Attitude trend = trend_at(scene, exposure);
  const Velocity velocity = scene.mission().satellite.aberration ? velocity_since_start(simulation, time) : Velocity{};
  std::vector<FieldStar> stars = field_stars(scene);
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const SceneStar& star = scene.stars()[i];
    const PixelShift drift = displacement(star.motion, trend);
    const PixelShift aberration = star.aberration.displacement(velocity);
    stars[i].position.x += drift.dx + aberration.dx;
    stars[i].position.y += drift.dy + aberration.dy;
  }
  return stars;
}

}  // namespace

GroundSegment perfect_ground_segment(const PreparedRun& run) {
  GroundSegment segment;
  for (const PreparedGroup& group : run.groups) {
    const Scene& scene = *group.scene;
    segment.grounds.push_back(perfect_ground(scene, group.targets));
    Ground& ground = segment.grounds.back();
    segment.estimators.emplace_back();
    segment.refreshes.emplace_back();
    segment.corrections.emplace_back();
    const PhotometrySettings& photometry = scene.mission().photometry;
    const auto build = [&](std::int64_t first, const Attitude& origin) {
      std::vector<StarEstimator> estimators = build_estimators(*scene.layout(), ground.model, photometry);
      if (photometry.jitter_correction != JitterCorrection::kNone)
        segment.corrections.back().push_back(
            {first, std::make_shared<const AttitudeCorrection>(scene, ground.model, estimators, origin)});
      if (first > 0)
        segment.refreshes.back().push_back({first, std::move(estimators)});
      else
        segment.estimators.back() = std::move(estimators);
    };
    const std::int64_t exposures = scene.mission().simulation.exposures;
    const std::int64_t each = exposures_per_refresh(scene);
    if (each == 0) {
      build(0, {});
      continue;
    }
    // From the last stretch to the first, whose places the ground then keeps.
    for (std::int64_t first = (exposures - 1) / each * each; first >= 0; first -= each) {
      const std::int64_t middle = first + (std::min(first + each, exposures) - first) / 2;
      ground.stars = stars_at(scene, middle);
      ground.model.stars = ground.stars;
      build(first, trend_at(scene, middle));
    }
    std::ranges::reverse(segment.refreshes.back());
    std::ranges::reverse(segment.corrections.back());
  }
  return segment;
}

std::vector<StreamGroup> stream_groups(const PreparedRun& run, const GroundSegment& ground) {
  std::vector<StreamGroup> groups;
  for (std::size_t g = 0; g < run.groups.size(); ++g) {
    const std::span<const StarEstimator> estimators =
        ground.estimators.empty() ? std::span<const StarEstimator>() : std::span(ground.estimators[g]);
    const std::span<const EstimatorRefresh> refreshes =
        ground.refreshes.empty() ? std::span<const EstimatorRefresh>() : std::span(ground.refreshes[g]);
    const std::span<const CorrectionStretch> corrections =
        ground.corrections.empty() ? std::span<const CorrectionStretch>() : std::span(ground.corrections[g]);
    groups.push_back(
        {run.groups[g].scene, run.groups[g].plan, estimators, run.groups[g].share, refreshes, corrections});
  }
  return groups;
}

Ground perfect_ground(const Scene& scene, std::span<const std::size_t> targets) {
  Ground ground;
  ground.stars = field_stars(scene);
  ground.model.stars = ground.stars;
  ground.model.targets = targets;
  ground.psf = psf_in_images(scene);
  ground.model.psf = ground.psf.get();
  ground.model.noise = expected_pixel_noise(scene.mission());
  ground.backgrounds = target_backgrounds(scene, targets);
  ground.model.backgrounds = ground.backgrounds;
  // What estimators have in common is decided by the targets of the full frame, whichever pixels are computed: the same
  // weights for a star in a window, a sub-field and the full frame.
  const std::vector<std::size_t> all = full_frame_targets(scene);
  ground.model.accuracy = scene.summary().accuracy;
  ground.model.faintest_electrons = all.empty() ? 0.0 : faintest_of(scene, all);
  ground.model.contamination_limit = scene.mission().analysis.uncontaminated_spr;
  const RunSetup setup = run_setup(scene.mission());
  // Jitter correction leaves so little of the motion that weights need not mind it.
  if (scene.mission().photometry.jitter_correction == JitterCorrection::kNone)
    ground.model.motion = motion_like_pixel_noise(mean_bin_motion(scene, all), setup.exposures_per_bin, setup.cameras);
  ground.model.gain = scene.mission().ccd.gain;
  ground.model.bias = scene.mission().ccd.bias;
  believe_readout(scene, ground.model);
  return ground;
}

}  // namespace astroid
