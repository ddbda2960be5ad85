#include "astroid/analysis/budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "astroid/analysis/group_mean.hpp"
#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/camera_groups.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/throughput.hpp"

namespace astroid {

namespace {

/// The mission, or what each of its groups of cameras makes of it.
std::vector<Mission> as_groups_see(const Mission& mission) {
  if (mission.telescope.group >= 0) return {mission};
  std::vector<Mission> seen;
  seen.reserve(static_cast<std::size_t>(group_count(mission.telescope)));
  for (int g = 0; g < group_count(mission.telescope); ++g) seen.push_back(group_mission(mission, g));
  return seen;
}

}  // namespace

StarEstimator estimator_of_first(const Mission& mission, const PixelPsf& psf, std::span<const FieldStar> stars) {
  const PhotometrySettings& photometry = mission.photometry;
  const double reach =
      std::max({static_cast<double>(photometry.mask_window), photometry.aperture_radius.value(),
                photometry.background == BackgroundMethod::kLocal ? photometry.annulus_outer.value() : 0.0});
  const PixelLayout layout({stamp_box(stars.front().position, reach + 1.0)});
  constexpr std::array<std::size_t, 1> kFirst{0};
  GroundModel model;
  model.stars = stars;
  model.targets = kFirst;
  model.psf = &psf;
  model.noise = expected_pixel_noise(mission);
  model.gain = mission.ccd.gain;
  model.bias = mission.ccd.bias;
  model.contamination_limit = mission.analysis.uncontaminated_spr;
  const RunSetup setup = run_setup(mission);
  model.motion = motion_like_pixel_noise(star_motion(mission, 0.0, 0.0).bin, setup.exposures_per_bin, setup.cameras);
  return build_estimators(layout, model, photometry).front();
}

std::vector<BudgetRow> analytic_budget(const Mission& mission, const PixelPsf& psf, std::span<const double> magnitudes,
                                       std::span<const BudgetNeighbour> neighbours) {
  const RunSetup setup = run_setup(mission);
  const std::vector<Mission> seen = as_groups_see(mission);
  std::vector<CrossMotion> motions;
  for (const Mission& a : seen)
    for (const Mission& b : seen) motions.push_back(cross_motion(a, b));
  double peak = 0.0;
  psf.integrate({0.0, 0.0}, {0, 0, 1, 1}, {&peak, 1});
  const auto share = [&](const Mission& camera) {
    return seen.size() > 1 ? group_share(camera.telescope, camera.telescope.group) : 1.0;
  };
  std::vector<BudgetRow> rows;
  for (const double magnitude : magnitudes) {
    BudgetRow row;
    row.mag = magnitude;
    std::vector<StarEstimator> estimators;
    for (const Mission& camera : seen) {
      const double electrons =
          mean_throughput(camera) *
          (electron_rate(Magnitude(magnitude), mission.telescope.zero_point) * mission.simulation.exposure_time)
              .value();
      const double background = expected_pixel_noise(camera).background;
      row.electrons += share(camera) * electrons;
      row.peak_electrons = std::max(row.peak_electrons, electrons * peak);
      row.saturated = row.saturated || electrons * peak + background >= saturation_electrons(camera);
      std::vector<FieldStar> stars{FieldStar{"", {0.0, 0.0}, electrons}};
      stars.reserve(neighbours.size() + 1);
      for (const BudgetNeighbour& n : neighbours)
        stars.push_back({"", {n.dx, n.dy}, electrons * flux_ratio(n.fainter)});
      estimators.push_back(estimator_of_first(camera, psf, stars));
    }
    std::vector<GroupView> groups;
    for (std::size_t g = 0; g < seen.size(); ++g) groups.push_back({&estimators[g], share(seen[g])});
    const StarEstimator estimator = mean_estimator(groups);
    row.spr_tot = estimator.spr_total;
    row.mask_pixels = estimator.mask_pixels;
    row.enclosed_fraction = estimator.enclosed_fraction;
    row.nsr_exposure = estimator.nsr_exposure;
    const PredictedNoise noise = predict_mean_noise(estimator, mean_motion_noise(groups, motions, setup), setup);
    row.nsr_1h_ppm = noise.bin.total();
    row.causes = noise.bin;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace astroid
