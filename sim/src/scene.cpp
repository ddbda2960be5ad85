#include "astroid/sim/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "astroid/core/digitise.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/throughput.hpp"
#include "effects/jitter_model.hpp"
#include "psf_sensitivity.hpp"
#include "reference_pixels.hpp"

namespace astroid {

namespace {

/// A star this far outside the frame gives less than this share of its light to it.
constexpr double kNegligibleShare = 1e-12;

std::shared_ptr<const AttitudeModel> make_attitude(const Mission& mission) {
  switch (mission.satellite.jitter.model) {
    case JitterModel::kNone:
      return make_still_attitude();
    case JitterModel::kRedNoise:
      // Attitude is the spacecraft's: camera and detector stay out of the address, so cameras share it.
      return make_red_noise_attitude(mission.satellite.jitter, mission.simulation,
                                     make_stream(mission.simulation.seed, JitterModelEffect::kSpec.id, 0, 0));
    case JitterModel::kFile:
      return make_file_attitude(mission.satellite.jitter.file, mission.simulation);
    case JitterModel::kSpectrum:
      break;  // no configuration says so yet
  }
  throw BugError("unknown jitter model");
}

/// Rms displacement along the worse of x and y.
double rms_px(const AttitudeJacobian& jacobian, const AttitudeVariance& variance) {
  const MotionCovariance motion = motion_covariance(jacobian, variance);
  return det::sqrt(std::max(motion.sxx, motion.syy));
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
    : mission_(mission), psf_(make_psf(mission)), attitude_(make_attitude(mission)) {
  const CcdSettings& ccd = mission_.ccd;
  projection_.emplace(make_projection(mission_));

  const double exposure = mission_.simulation.exposure_time.value();
  const AttitudeVariance jitter = attitude_->variance();
  std::size_t not_projectable = 0;
  std::size_t too_faint = 0;
  std::size_t outside = 0;
  const double reach = psf_->stamp_half_width(kNegligibleShare);
  const double passed = mean_throughput(mission_);
  for (const CatalogueStar& star : catalogue.stars) {
    SceneStar s;
    s.id = star.id;
    if (catalogue.positions == PositionKind::kSky) {
      const std::optional<PixelPosition> position = projection_->to_pixel(star.sky);
      if (!position) {
        ++not_projectable;
        continue;
      }
      s.sky = star.sky;
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
    stars_.push_back(std::move(s));
  }
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
  std::vector<Rectangle> reference = reference_regions(regions, detector(), ccd.reference);
  layout_ = std::make_shared<const PixelLayout>(std::move(regions), reference);

  SceneSummary& s = summary_;
  s.mission = &mission_;
  s.psf = measure_sensitivity(*psf_);
  s.accuracy = 1e-6 * mission_.simulation.accuracy.value();
  s.cameras = mission_.telescope.cameras;
  s.exposures_per_bin = std::max(1.0, std::floor(mission_.analysis.bin / mission_.simulation.cycle));
  s.background = (passed * mission_.field.sky_background + ccd.dark_current).value() * exposure;
  const double readout = ccd.readout_noise.value();
  const double quantisation = ccd.gain.value() / kSqrt12;
  s.pixel_noise_variance = s.background + readout * readout + quantisation * quantisation;
  const double radius = mission_.photometry.aperture_radius.value();
  const double side = mission_.photometry.mask_window;
  s.aperture_pixels = mission_.photometry.method == PhotometryMethod::kAperture ? kPi * radius * radius : side * side;
  const double in_exposure_yaw = std::max(0.0, jitter.yaw - attitude_->variance_of_mean(1).yaw);
  const double in_exposure_pitch = std::max(0.0, jitter.pitch - attitude_->variance_of_mean(1).pitch);
  const double in_exposure_roll = std::max(0.0, jitter.roll - attitude_->variance_of_mean(1).roll);
  s.faintest_target_electrons = std::numeric_limits<double>::infinity();
  for (const SceneStar& star : stars_) {
    s.attitude_rms_px = std::max(s.attitude_rms_px, rms_px(star.motion, jitter));
    s.attitude_rms_in_exposure_px = std::max(
        s.attitude_rms_in_exposure_px, rms_px(star.motion, {in_exposure_yaw, in_exposure_pitch, in_exposure_roll}));
    if (star.electrons > s.brightest_electrons) {
      s.brightest_electrons = star.electrons;
      s.brightest_id = star.id;
      s.brightest_magnitude = star.magnitude.value();
    }
    // Decisions are the same for windows and full frame, so "target" here is by brightness alone.
    if (may_be_target(star, mission_)) {
      ++s.targets;
      // What a saturated star's flux means does not depend on ppm.
      const double unsaturated = ccd.full_well.value() / s.psf.peak_fraction;
      s.brightest_target_electrons = std::max(s.brightest_target_electrons, std::min(star.electrons, unsaturated));
      s.faintest_target_electrons = std::min(s.faintest_target_electrons, star.electrons);
    }
  }
  if (s.targets == 0) s.faintest_target_electrons = 0.0;
  s.stars = stars_.size();
  for (const Ghost& ghost : ghosts_) s.ghost_light += ghost.electrons / disc_area(mission_.telescope.ghosts);
  s.ghosts = ghosts_.size();
  s.peak_pixel_bound = peak_pixel_bound(stars_, s.psf.peak_fraction) + s.background + s.ghost_light;
  for (const double x : {-0.5, ccd.columns - 0.5})
    for (const double y : {-0.5, ccd.rows - 0.5})
      s.least_vignetting =
          std::min(s.least_vignetting, vignetting_at(mission_.telescope.vignetting, *projection_, {x, y}));
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

Seconds Scene::mid_time(std::int64_t exposure) const {
  // From the integer exposure number, so that no error accumulates over years.
  return Seconds(static_cast<double>(exposure) * mission_.simulation.cycle.value() +
                 0.5 * mission_.simulation.exposure_time.value());
}

}  // namespace astroid
