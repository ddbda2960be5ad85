#include "astroid/analysis/budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/photometric.hpp"

namespace astroid {

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
  const StarMotion motion = star_motion(mission, 0.0, 0.0);
  const double background = expected_pixel_noise(mission).background;
  double peak = 0.0;
  psf.integrate({0.0, 0.0}, {0, 0, 1, 1}, {&peak, 1});
  std::vector<BudgetRow> rows;
  for (const double magnitude : magnitudes) {
    BudgetRow row;
    row.mag = magnitude;
    row.electrons =
        (electron_rate(Magnitude(magnitude), mission.telescope.zero_point) * mission.simulation.exposure_time).value();
    row.peak_electrons = row.electrons * peak;
    row.saturated = row.peak_electrons + background >= saturation_electrons(mission);
    std::vector<FieldStar> stars{FieldStar{"", {0.0, 0.0}, row.electrons}};
    stars.reserve(neighbours.size() + 1);
    for (const BudgetNeighbour& n : neighbours)
      stars.push_back({"", {n.dx, n.dy}, row.electrons * flux_ratio(n.fainter)});
    const StarEstimator estimator = estimator_of_first(mission, psf, stars);
    row.spr_tot = estimator.spr_total;
    row.mask_pixels = estimator.mask_pixels;
    row.enclosed_fraction = estimator.enclosed_fraction;
    row.nsr_exposure = estimator.nsr_exposure;
    const PredictedNoise noise = predict_noise(estimator, motion, setup);
    row.nsr_1h_ppm = noise.bin.total();
    row.causes = noise.bin;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace astroid
