#include "astroid/sim/smearing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/column_light.hpp"
#include "astroid/core/throughput.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {

/// Share of the tightest tolerance that the light beyond a star's stamp may smear into an aperture.
constexpr double kTruncation = 0.01;

double share_of(const Scene& scene) {
  const Mission& mission = scene.mission();
  if (mission.ccd.smearing.model == SmearingModel::kNone) return 0.0;
  return clocking_share(mission.ccd.smearing.time.value(), mission.simulation.exposure_time.value(), mission.ccd.rows);
}

/// A star as it is smeared: with the share of its light that each row collects.
StarLight smeared_star(const Scene& scene, const SceneStar& star, double share) {
  constexpr double kSmallestLoss = 1e-9;
  constexpr double kLargestLoss = 0.5;
  const SceneSummary& summary = scene.summary();
  // The conditions' throughput is applied to whole columns.
  const double passed = mean_throughput(scene.mission());
  const double smeared = star.electrons * share / passed;
  const double allowed = kTruncation * summary.tightest_tolerance() / (summary.aperture_pixels * smeared);
  return {.centre = star.position,
          .electrons = smeared,
          .half_width = scene.psf().stamp_half_width(std::clamp(allowed, kSmallestLoss, kLargestLoss))};
}

/// Sky and stray light of one pixel, e- per exposure.
double sky_of_pixel(const Mission& mission) {
  return (mean_background_rate(mission) * mission.simulation.exposure_time).value();
}

/// Before the optics take their part, which the conditions know.
double smeared_sky(const Scene& scene) {
  const Mission& mission = scene.mission();
  return share_of(scene) * mission.ccd.rows * sky_of_pixel(mission) / mean_throughput(mission);
}

}  // namespace

SmearedColumns::SmearedColumns(const Scene& scene, int first, int columns)
    : first_(first), electrons_(static_cast<std::size_t>(columns), 0.0) {
  for (auto& change : per_arcsec_) change.assign(electrons_.size(), 0.0);
  const Rectangle detector = scene.detector();
  const double share = share_of(scene);
  if (share <= 0.0) return;
  std::vector<double> scratch;
  std::vector<double> along_x;
  std::vector<double> along_y;
  for (const SceneStar& star : scene.stars()) {
    if (!(star.electrons > 0.0)) continue;
    const StarLight light = smeared_star(scene, star, share);
    const Rectangle box =
        intersect(stamp_box(light.centre, light.half_width), {first, detector.y0, columns, detector.ny});
    if (box.empty()) continue;
    add_column_light(scene.psf(), light, detector, first, electrons_, scratch);
    along_x.assign(static_cast<std::size_t>(box.nx), 0.0);
    along_y.assign(static_cast<std::size_t>(box.nx), 0.0);
    add_column_gradient(scene.psf(), light, detector, box.x0, along_x, along_y, scratch);
    const AttitudeJacobian& j = star.motion;
    const auto begin = static_cast<std::size_t>(box.x0 - first);
    for (std::size_t i = 0; i < along_x.size(); ++i) {
      per_arcsec_[0][begin + i] += along_x[i] * j.dx_dyaw + along_y[i] * j.dy_dyaw;
      per_arcsec_[1][begin + i] += along_x[i] * j.dx_dpitch + along_y[i] * j.dy_dpitch;
      per_arcsec_[2][begin + i] += along_x[i] * j.dx_droll + along_y[i] * j.dy_droll;
    }
  }
  const double sky = smeared_sky(scene);
  for (int x = std::max(first, detector.x0); x < std::min(first + columns, detector.x1()); ++x)
    electrons_[static_cast<std::size_t>(x - first)] += sky;
}

void SmearedColumns::at(const Attitude& attitude, double throughput, int x0, std::span<double> row) const {
  const auto begin = static_cast<std::size_t>(x0 - first_);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::size_t k = begin + i;
    const double moved =
        attitude.yaw * per_arcsec_[0][k] + attitude.pitch * per_arcsec_[1][k] + attitude.roll * per_arcsec_[2][k];
    // Motion may take away what little a column has, but no more.
    row[i] = std::max(0.0, throughput * (electrons_[k] + moved));
  }
}

Plane<float, unit::ExpectedElectrons> missing_from_above(const Scene& scene,
                                                         const std::shared_ptr<const PixelLayout>& layout) {
  const SmearingSettings& smearing = scene.mission().ccd.smearing;
  const double missing = 1.0 - smearing.clear_time / smearing.time;
  if (smearing.model != SmearingModel::kFrameTransfer || missing == 0.0) return {};
  const Rectangle detector = scene.detector();
  const double share = share_of(scene) * missing;
  const double sky = smeared_sky(scene) * missing / std::max(1, detector.ny);
  Plane<float, unit::ExpectedElectrons> result(layout);
  std::vector<StarLight> stars;
  std::vector<double> fractions;
  for (const SceneStar& star : scene.stars())
    if (star.electrons > 0.0) stars.push_back(smeared_star(scene, star, share_of(scene)));
  for (std::size_t r = 0; r < layout->exposed_regions().size(); ++r) {
    const Rectangle& area = layout->regions()[r];
    const auto width = static_cast<std::size_t>(area.nx);
    // Light of each row from the first of the region on, the last one standing for all rows beyond it.
    std::vector<double> rows(area.size() + width, 0.0);
    for (const StarLight& star : stars) {
      const Rectangle box = intersect(intersect(stamp_box(star.centre, star.half_width), detector),
                                      {area.x0, area.y0, area.nx, detector.y1() - area.y0});
      if (box.empty()) continue;
      fractions.resize(box.size());
      scene.psf().integrate(star.centre, box, fractions);
      for (int y = box.y0; y < box.y1(); ++y) {
        double* row = rows.data() + static_cast<std::size_t>(std::min(y, area.y1()) - area.y0) * width;
        const double* fraction =
            fractions.data() + static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.nx);
        for (int x = box.x0; x < box.x1(); ++x)
          row[x - area.x0] += star.electrons / share_of(scene) * share * fraction[x - box.x0];
      }
    }
    const auto view = result.view(r);
    for (std::size_t i = 0; i < width; ++i) {
      double above = rows[area.size() + i];
      for (int y = area.y1() - 1; y >= area.y0; --y) {
        // A packet sits in its own row for half of the step that begins the transfer, and of the one that ends it.
        const double own = rows[static_cast<std::size_t>(y - area.y0) * width + i];
        view.row(y)[i] = static_cast<float>(above + 0.5 * own + sky * (detector.y1() - 0.5 - y));
        above += own;
      }
    }
  }
  return result;
}

std::vector<double> smeared_electrons(const Scene& scene) {
  if (scene.mission().ccd.smearing.model == SmearingModel::kNone) return {};
  std::vector<double> electrons(static_cast<std::size_t>(scene.detector().nx));
  SmearedColumns(scene, 0, scene.detector().nx).at({}, mean_throughput(scene.mission()), 0, electrons);
  return electrons;
}

double brightest_column_bound(const Scene& scene) {
  constexpr int kCell = 4;  // columns; the light of a star two cells away is negligible beside the star's own
  std::map<int, double> cells;
  for (const SceneStar& star : scene.stars())
    cells[static_cast<int>(std::floor(star.position.x / kCell))] += star.electrons;
  double highest = 0.0;
  for (const auto& [cell, unused] : cells) {
    double sum = 0.0;
    for (int k = cell - 1; k <= cell + 1; ++k) {
      const auto neighbour = cells.find(k);
      if (neighbour != cells.end()) sum += neighbour->second;
    }
    highest = std::max(highest, sum);
  }
  return highest + scene.mission().ccd.rows * sky_of_pixel(scene.mission());
}

}  // namespace astroid
