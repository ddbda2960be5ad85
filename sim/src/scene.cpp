#include "astroid/sim/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "astroid/catalogues/proper_motion.hpp"
#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/run_time.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/core/throughput.hpp"
#include "astroid/core/units.hpp"
#include "astroid/sim/accuracy_shares.hpp"
#include "astroid/sim/smearing.hpp"
#include "effects/drift.hpp"
#include "effects/jitter_model.hpp"
#include "effects/repointing.hpp"
#include "psf_sensitivity.hpp"
#include "reference_pixels.hpp"

namespace astroid {

namespace {

/// A star this far outside the frame gives less than this share of its light to it.
constexpr double kNegligibleShare = 1e-12;

/// Attitude is the spacecraft's: camera and detector stay out of the address, so cameras share it. Jitter has the
/// quarter there instead, for its steps are counted from the start of the run.
RandomStream attitude_stream(const Mission& mission, StreamId effect, std::uint32_t quarter = 0) {
  return make_stream(mission.simulation.seed, effect, 0, quarter);
}

std::shared_ptr<const AttitudeModel> make_jitter(const Mission& mission) {
  const JitterSettings& jitter = mission.satellite.jitter;
  const RandomStream stream =
      attitude_stream(mission, JitterModelEffect::kSpec.id, static_cast<std::uint32_t>(mission.simulation.quarter));
  switch (mission.satellite.jitter.model) {
    case JitterModel::kNone:
      return make_still_attitude();
    case JitterModel::kRedNoise:
      return make_red_noise_attitude(jitter, mission.simulation, stream, mission.telescope.groups.stagger);
    case JitterModel::kFile:
      return make_file_attitude(jitter.file, mission.simulation);
    case JitterModel::kSpectrum:
      return make_spectrum_attitude(read_jitter_spectrum(jitter.file), jitter.file, mission.simulation, stream);
  }
  throw BugError("unknown jitter model");
}

/// Rms displacement along the worse of x and y.
double rms_px(const AttitudeJacobian& jacobian, const AttitudeVariance& variance) {
  const MotionCovariance motion = motion_covariance(jacobian, variance);
  return det::sqrt(std::max(motion.sxx, motion.syy));
}

/// Displacement of a star by at most so much about each axis.
double farthest_px(const AttitudeJacobian& j, const Attitude& attitude) {
  return det::hypot(std::fabs(j.dx_dyaw) * attitude.yaw + std::fabs(j.dx_dpitch) * attitude.pitch +
                        std::fabs(j.dx_droll) * attitude.roll,
                    std::fabs(j.dy_dyaw) * attitude.yaw + std::fabs(j.dy_dpitch) * attitude.pitch +
                        std::fabs(j.dy_droll) * attitude.roll);
}

/// The fastest that aberration moves a star in the year.
double aberration_px_per_second(const AberrationJacobian& j) {
  constexpr double kLargestAcceleration = 2.1e-11;  // of the Earth's velocity in units of c, per second, at perihelion
  const auto length = [](const Velocity& v) { return det::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
  return kLargestAcceleration * det::hypot(length(j.x), length(j.y));
}

/// Velocities of the spacecraft relative to the start, over the run.
std::vector<Velocity> velocities(const SimulationSettings& simulation) {
  constexpr int kPieces = 32;
  const Seconds length(static_cast<double>(simulation.exposures) * simulation.cycle.value());
  std::vector<Velocity> all;
  for (int i = 1; i <= kPieces; ++i) all.push_back(velocity_since_start(simulation, (1.0 * i / kPieces) * length));
  return all;
}

Rectangle grown(const Rectangle& r, int margin) {
  return {r.x0 - margin, r.y0 - margin, r.nx + 2 * margin, r.ny + 2 * margin};
}

bool inside(const Rectangle& r, PixelPosition p) {
  return p.x >= r.x0 - 0.5 && p.x < r.x1() - 0.5 && p.y >= r.y0 - 0.5 && p.y < r.y1() - 0.5;
}

/// Whether a star is bright enough, wherever it is.
bool may_be_target(const SceneStar& star, const Mission& mission) {
  return star.magnitude <= mission.photometry.target_limit && star.electrons > 0.0;
}

/// px².
double disc_area(const GhostSettings& ghosts) {
  return kPi * ghosts.radius.value() * ghosts.radius.value();
}

/// The window of side `size` around a star, as masks see it: 6 px start at floor(x) - 2.
Rectangle window_around(PixelPosition p, int size) {
  const int back = (size - 1) / 2;
  return {static_cast<int>(std::floor(p.x)) - back, static_cast<int>(std::floor(p.y)) - back, size, size};
}

/// Upper bound of the expected electrons in a pixel: all light within a cell of a coarse grid and its neighbours, as
/// concentrated as the PSF allows.
double peak_pixel_bound(std::span<const SceneStar> stars, double peak_fraction) {
  constexpr int kCell =
      4;  // px; the light of a star two cells away is negligible in a pixel beside the star's own peak
  std::map<std::pair<int, int>, double> cells;
  const auto cell = [](double v) { return static_cast<int>(std::floor(v / kCell)); };
  for (const SceneStar& star : stars) cells[{cell(star.position.x), cell(star.position.y)}] += star.electrons;
  double highest = 0.0;
  for (const auto& [at, unused] : cells) {
    double sum = 0.0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto neighbour = cells.find({at.first + dx, at.second + dy});
        if (neighbour != cells.end()) sum += neighbour->second;
      }
    highest = std::max(highest, sum * peak_fraction);
  }
  return highest;
}

/// Of the faintest target, the wings of so many of the brightest star are thought to reach.
constexpr double kNeighbours = 4.0;

/// What the PSF may err: by the share of the accuracy that is its own, of the light in an aperture, which is that of
/// the faintest target where the wings of brighter stars are less.
PsfAccuracy psf_accuracy_of(const SceneSummary& s) {
  // Stars more than so much brighter are taken as this much brighter.
  constexpr double kFaintest = 1e-3;
  constexpr double kLargest = 0.3;  // of a star's own light in a small aperture
  const double brightest = kNeighbours * s.brightest_electrons;
  const double light = s.targets > 0 && brightest > 0.0 ? s.tightest_tolerance() / s.accuracy / brightest : kLargest;
  return {kAccuracyShares.psf * s.accuracy, std::clamp(light, kFaintest, kLargest)};
}

}  // namespace

double star_electrons(Magnitude magnitude, const TelescopeSettings& telescope, Seconds exposure_time) {
  return (electron_rate(magnitude, telescope.zero_point) * exposure_time).value();
}

std::vector<std::size_t> full_frame_targets(const Scene& scene) {
  std::vector<std::size_t> targets;
  for (std::size_t i = 0; i < scene.stars().size(); ++i)
    if (may_be_target(scene.stars()[i], scene.mission()) && inside(scene.detector(), scene.stars()[i].position))
      targets.push_back(i);
  return targets;
}

Scene::Scene(const Mission& mission, const StarCatalogue& catalogue)
    : mission_(mission), renderer_(choose_renderer(mission)), jitter_(make_jitter(mission)) {
  // What a camera sees is that of its group (group_mission()).
  ASTROID_CHECK_LE(mission_.telescope.groups.cameras.empty() ? -1 : 0, mission_.telescope.group);
  const CcdSettings& ccd = mission_.ccd;
  const SatelliteSettings& satellite = mission_.satellite;
  drift_ = thermo_elastic_drift(satellite, mission_.simulation, attitude_stream(mission_, DriftEffect::kSpec.id));
  repointing_ = repointing_error(satellite, mission_.simulation, attitude_stream(mission_, RepointingEffect::kSpec.id));
  trend_ = drift_ + repointing_;
  attitude_ = make_drifting_attitude(jitter_, trend_, mission_.simulation);
  if (line_time(mission_).value() > 0.0) (void)gapless_attitude({.jitter = true});  // which a file may not cover
  bad_pixels_ = read_bad_pixels(mission_);
  const CameraPointing pointing = make_pointing(mission_);
  projection_.emplace(pointing);

  if (mission_.field.sky == SkyModel::kZodiacal) find_sky();
  summary_.epoch =
      julian_year(mission_.simulation.start_mjd + middle_of_run(mission_.simulation).value() / kSecondsPerDay);

  const double exposure = mission_.simulation.exposure_time.value();
  const AttitudeVariance jitter = attitude_->variance();
  std::size_t not_projectable = 0;
  std::size_t too_faint = 0;
  std::size_t outside = 0;
  const double reach = psf_reach(mission_, kNegligibleShare);
  const double passed = mean_throughput(mission_);
  for (const CatalogueStar& star : catalogue.stars) {
    SceneStar s;
    s.id = star.id;
    if (catalogue.positions == PositionKind::kSky) {
      const bool moves = mission_.field.proper_motion && (star.pm_ra != 0.0 || star.pm_dec != 0.0);
      const double epoch = star.epoch > 0.0 ? star.epoch : mission_.field.catalogue_epoch;
      s.sky = moves ? moved(star.sky, {star.pm_ra, star.pm_dec}, summary_.epoch - epoch) : star.sky;
      if (moves) {
        ++summary_.moved_stars;
        constexpr double kArcsecPerDegree = 3600.0;
        summary_.proper_motion_px = std::max(summary_.proper_motion_px, angular_separation(s.sky, star.sky).value() *
                                                                            kArcsecPerDegree / ccd.pixel_scale.value());
      }
      const std::optional<PixelPosition> position = projection_->to_pixel(s.sky);
      if (!position) {
        ++not_projectable;
        continue;
      }
      s.position = *position;
    } else {
      s.sky = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
      s.position = star.pixel;
    }
    if (catalogue.brightness == BrightnessKind::kElectrons) {
      s.electrons = star.electrons;
      constexpr double kPogsonScale = 2.5;
      s.magnitude = mission_.telescope.zero_point - DeltaMag(kPogsonScale * det::log10(star.electrons / exposure));
    } else {
      s.magnitude = star.magnitude;
      s.electrons = star_electrons(star.magnitude, mission_.telescope, mission_.simulation.exposure_time);
    }
    if (s.magnitude > mission_.field.faint_limit) {
      ++too_faint;
      continue;
    }
    const SkyPosition direction = catalogue.positions == PositionKind::kSky ? s.sky : projection_->to_sky(s.position);
    add_ghost(s, direction);
    const int margin = static_cast<int>(std::ceil(reach)) + 1;
    if (!inside(grown(detector(), margin), s.position)) {
      ++outside;
      continue;
    }
    s.response = passed * vignetting_at(mission_.telescope.vignetting, *projection_, s.position);
    s.electrons *= s.response;
    s.motion = projection_->attitude_jacobian(direction).value_or(AttitudeJacobian{});
    if (satellite.aberration) s.aberration = aberration_jacobian(direction, *pointing.spacecraft, s.motion);
    stars_.push_back(std::move(s));
  }
  read_variable_stars(catalogue);
  if (not_projectable > 0)
    notes_.push_back(fmt::format("{} stars lie behind the horizon of the projection", not_projectable));
  if (outside > 0) notes_.push_back(fmt::format("{} stars of the catalogue fall outside the detector", outside));
  if (too_faint > 0) notes_.push_back(fmt::format("{} stars are fainter than the faint limit and left out", too_faint));
  notes_.insert(notes_.end(), catalogue.notes.begin(), catalogue.notes.end());

  // The computed pixels.
  std::vector<Rectangle> regions;
  const Rectangle area =
      ccd.has_sub_field ? intersect(detector(), {ccd.sub_x0, ccd.sub_y0, ccd.sub_columns, ccd.sub_rows}) : detector();
  for (std::size_t i = 0; i < stars_.size(); ++i) {
    SceneStar& star = stars_[i];
    star.is_target = may_be_target(star, mission_) && inside(area, star.position);
    if (!star.is_target) continue;
    targets_.push_back(i);
    if (ccd.window > 0) regions.push_back(intersect(detector(), window_around(star.position, ccd.window)));
  }
  if (ccd.window <= 0) regions.push_back(area);
  if (regions.empty())
    throw InputError(Problem{
        .file = catalogue.source,
        .parameter = "CCD/Windows",
        .expected = "targets on the detector",
        .message =
            fmt::format("none of the {} stars is a target, so there is no window to compute", catalogue.stars.size())});
  std::vector<Rectangle> reference = reference_regions(regions, detector(), ccd.reference, ccd.nodes.count);
  layout_ = std::make_shared<const PixelLayout>(std::move(regions), reference);

  SceneSummary& s = summary_;
  s.mission = &mission_;
  s.listed_dead = bad_pixels_.dead.size();
  s.listed_hot = bad_pixels_.hot.size();
  for (const HotPixel& hot : bad_pixels_.hot) s.hottest = std::max(s.hottest, hot.current.value() * exposure);
  s.accuracy = 1e-6 * mission_.simulation.accuracy.value();
  s.cameras = mission_.telescope.cameras;
  s.exposures_per_bin = std::max(1.0, std::floor(mission_.analysis.bin / mission_.simulation.cycle));
  const ElectronsPerSecond from_sky = mean_background_rate(mission_);
  s.sky = (from_sky - passed * mission_.field.stray_light.level).value() * exposure;
  s.background = (from_sky + ccd.dark_current).value() * exposure;
  s.pixel_noise_variance = expected_pixel_noise(mission_).variance();
  const double radius = mission_.photometry.aperture_radius.value();
  const double side = mission_.photometry.mask_window;
  s.aperture_pixels = mission_.photometry.method == PhotometryMethod::kAperture ? kPi * radius * radius : side * side;
  const AttitudeVariance kept = attitude_->variance_of_mean(1);
  const auto in_exposure = [exposure](double all, double mean, double rate) {
    // A straight line of length rate x exposure has this variance, whatever else moves.
    return std::max(0.0, all - mean) + rate * rate * exposure * exposure / 12.0;
  };
  const Attitude& fastest = trend_.fastest();
  const AttitudeVariance within{in_exposure(jitter.yaw, kept.yaw, fastest.yaw),
                                in_exposure(jitter.pitch, kept.pitch, fastest.pitch),
                                in_exposure(jitter.roll, kept.roll, fastest.roll)};
  const std::vector<Velocity> velocity =
      satellite.aberration ? velocities(mission_.simulation) : std::vector<Velocity>{};
  s.faintest_target_electrons = std::numeric_limits<double>::infinity();
  double brightest_target = 0.0;
  for (const SceneStar& star : stars_) {
    s.attitude_rms_px = std::max(s.attitude_rms_px, rms_px(star.motion, jitter));
    s.attitude_rms_in_exposure_px = std::max(s.attitude_rms_in_exposure_px, rms_px(star.motion, within));
    s.drift_px = std::max(s.drift_px, farthest_px(star.motion, drift_.farthest()));
    s.drift_px_per_second = std::max(s.drift_px_per_second, farthest_px(star.motion, trend_.fastest()));
    s.repointing_px = std::max(s.repointing_px, farthest_px(star.motion, repointing_.farthest()));
    for (const Velocity& v : velocity) {
      const PixelShift shift = star.aberration.displacement(v);
      s.aberration_px = std::max(s.aberration_px, det::hypot(shift.dx, shift.dy));
    }
    s.aberration_px_per_second = std::max(s.aberration_px_per_second, aberration_px_per_second(star.aberration));
    if (star.electrons > s.brightest_electrons) {
      s.brightest_electrons = star.electrons;
      s.brightest_id = star.id;
      s.brightest_magnitude = star.magnitude.value();
    }
    // Decisions are the same for windows and full frame, so "target" here is by brightness alone.
    if (may_be_target(star, mission_)) {
      ++s.targets;
      brightest_target = std::max(brightest_target, star.electrons);
      s.faintest_target_electrons = std::min(s.faintest_target_electrons, star.electrons);
    }
  }
  if (s.targets == 0) s.faintest_target_electrons = 0.0;
  const PsfAccuracy psf_accuracy = psf_accuracy_of(s);
  optical_psf_ = make_psf(mission_, psf_accuracy);
  psf_ = make_recorded_psf(mission_, psf_accuracy, optical_psf_);
  s.psf = measure_sensitivity(*psf_);
  // What a saturated star's flux means does not depend on ppm.
  s.brightest_target_electrons = std::min(brightest_target, ccd.full_well.value() / s.psf.peak_fraction);
  s.stars = stars_.size();
  for (const Ghost& ghost : ghosts_) s.ghost_light += ghost.electrons / disc_area(mission_.telescope.ghosts);
  s.ghosts = ghosts_.size();
  s.peak_pixel_bound = peak_pixel_bound(stars_, s.psf.peak_fraction) + s.background + s.ghost_light;
  for (const double x : {-0.5, ccd.columns - 0.5})
    for (const double y : {-0.5, ccd.rows - 0.5})
      s.least_vignetting =
          std::min(s.least_vignetting, vignetting_at(mission_.telescope.vignetting, *projection_, {x, y}));
  if (ccd.charge_injection.every_rows > 0) s.peak_pixel_bound += ccd.charge_injection.level.value();
  if (ccd.smearing.model != SmearingModel::kNone) s.brightest_column = brightest_column_bound(*this);
  if (renderer_.renderer == Renderer::kSubPixel) {
    // What a bright star may leave on a faint target, as with stamps.
    constexpr double kRounding = 1e-13;
    const double brightest = kNeighbours * std::max(s.brightest_electrons, 1.0);
    sub_pixel_renderer_ =
        make_sub_pixel_renderer(mission_, kAccuracyShares.psf * s.accuracy,
                                std::max(kRounding, kAccuracyShares.psf * s.tightest_tolerance() / brightest));
  }
}

void Scene::read_variable_stars(const StarCatalogue& catalogue) {
  if (mission_.field.variables.empty()) return;
  variables_ =
      read_variables(mission_.field.variables, (quarter_start(mission_) + end_of_run(mission_.simulation)).value());
  std::unordered_map<std::string, int> number;
  for (std::size_t i = 0; i < variables_.size(); ++i) number[variables_[i].id] = static_cast<int>(i);
  std::unordered_set<std::string> known;
  for (const CatalogueStar& star : catalogue.stars)
    if (number.contains(star.id)) known.insert(star.id);
  std::vector<Problem> problems;
  for (const VariableStar& variable : variables_)
    if (!known.contains(variable.id))
      problems.push_back({.file = mission_.field.variables,
                          .line = variable.line,
                          .parameter = "column id",
                          .value = variable.id,
                          .expected = fmt::format("an id of {}", catalogue.source),
                          .message = "is not a star of the catalogue"});
  if (!problems.empty()) throw InputError(std::move(problems));
  for (SceneStar& star : stars_) {
    const auto found = number.find(star.id);
    if (found == number.end()) continue;
    star.variability = found->second;
    ++summary_.variable_stars;
    const double change = variables_[static_cast<std::size_t>(found->second)].variability.largest_change();
    summary_.largest_variation = std::max(summary_.largest_variation, change * star.electrons);
  }
  if (summary_.variable_stars < variables_.size())
    notes_.push_back(
        fmt::format("{} variable stars are not on the detector", variables_.size() - summary_.variable_stars));
}

void Scene::find_sky() {
  rate_of_s10_ = rate_of_one_s10(mission_);
  const Rectangle d = detector();
  const PixelPosition places[] = {
      {d.x0 - 0.5, d.y0 - 0.5}, {d.x1() - 0.5, d.y0 - 0.5}, {d.x0 - 0.5, d.y1() - 0.5}, {d.x1() - 0.5, d.y1() - 0.5}};
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    corners_[i] = projection_->to_sky(places[i]);
    if (!std::isfinite(corners_[i].ra)) corners_[i] = projection_->axis();  // beyond the projection
  }
  // The whole run must be far enough from the Sun, which moves by 5 deg in this time and comes again after a year.
  constexpr double kStep = 5.0 * 86400.0;
  constexpr double kYear = 366.0 * 86400.0;
  const double end = std::min(end_of_run(mission_.simulation).value(), kYear);
  for (double time = 0.0; time < end + kStep; time += kStep)
    for (std::size_t i = 0; i < corners_.size(); ++i) (void)sky_at_corner(i, Seconds(std::min(time, end)));
}

ElectronsPerSecond Scene::sky_at_corner(std::size_t corner, Seconds time) const {
  return sky_rate(mission_, rate_of_s10_, corners_[corner], time);
}

std::shared_ptr<const AttitudeModel> Scene::attitude(const AttitudeParts& parts) const {
  const AttitudeTrend drift = parts.drift ? drift_ : AttitudeTrend();
  const AttitudeTrend repointing = parts.repointing ? repointing_ : AttitudeTrend();
  return make_drifting_attitude(parts.jitter ? jitter_ : make_still_attitude(), drift + repointing,
                                mission_.simulation);
}

std::shared_ptr<const AttitudeModel> Scene::gapless_attitude(const AttitudeParts& parts) const {
  Mission gapless = mission_;
  gapless.simulation.exposure_time = gapless.simulation.cycle;
  const AttitudeTrend drift = parts.drift ? drift_ : AttitudeTrend();
  const AttitudeTrend repointing = parts.repointing ? repointing_ : AttitudeTrend();
  return make_drifting_attitude(parts.jitter ? make_jitter(gapless) : make_still_attitude(), drift + repointing,
                                gapless.simulation);
}

void Scene::add_ghost(const SceneStar& star, SkyPosition direction) {
  const GhostSettings& settings = mission_.telescope.ghosts;
  if (!(settings.fraction > 0.0) || !(star.magnitude < settings.brighter_than) || !(star.electrons > 0.0)) return;
  const PixelPosition axis = projection_->axis_pixel();
  Ghost ghost{.position = {2.0 * axis.x - star.position.x, 2.0 * axis.y - star.position.y},
              .electrons = settings.fraction * star.electrons,
              .motion = {}};
  const auto farthest = grown(detector(), static_cast<int>(std::ceil(settings.radius.value())) + 2);
  if (!inside(farthest, ghost.position)) return;
  const AttitudeJacobian j = projection_->attitude_jacobian(direction).value_or(AttitudeJacobian{});
  ghost.motion = {-j.dx_dyaw, -j.dx_dpitch, -j.dx_droll, -j.dy_dyaw, -j.dy_dpitch, -j.dy_droll};
  ghosts_.push_back(ghost);
}

Seconds Scene::mission_time(std::int64_t exposure) const {
  return quarter_start(mission_) + mid_time(exposure);
}

std::int64_t Scene::mission_number(std::int64_t exposure) const {
  const double before = std::ceil(quarter_start(mission_) / mission_.simulation.cycle);
  return exposure + static_cast<std::int64_t>(before);
}

Seconds Scene::mid_time(std::int64_t exposure) const {
  // From the integer exposure number, so that no error accumulates over years.
  return mission_.simulation.stagger + Seconds(static_cast<double>(exposure) * mission_.simulation.cycle.value() +
                                               0.5 * mission_.simulation.exposure_time.value());
}

}  // namespace astroid
