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

/// Share of the light of `rows` rows that each of them collects.
double share_of(const Scene& scene, int rows) {
  const Mission& mission = scene.mission();
  if (mission.ccd.smearing.model == SmearingModel::kNone) return 0.0;
  return clocking_share(mission.ccd.smearing.time.value(), mission.simulation.exposure_time.value(), rows);
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

/// Of a whole column of `rows` rows, before the optics take their part, which the conditions know.
double smeared_sky(const Scene& scene, int rows) {
  const Mission& mission = scene.mission();
  return share_of(scene, rows) * rows * sky_of_pixel(mission) / mean_throughput(mission);
}

}  // namespace

ReadoutNodes readout_nodes(const Scene& scene) {
  return {scene.detector(), scene.mission().ccd.nodes.count};
}

SmearedColumns::SmearedColumns(const Scene& scene, int first, int columns, int half)
    : first_(first), electrons_(static_cast<std::size_t>(columns), 0.0) {
  for (auto& change : per_arcsec_) change.assign(electrons_.size(), 0.0);
  const Rectangle rows = readout_nodes(scene).half(scene.detector(), half);
  const double share = share_of(scene, rows.ny);
  if (share <= 0.0) return;
  std::vector<double> scratch;
  std::vector<double> along_x;
  std::vector<double> along_y;
  for (const SceneStar& star : scene.stars()) {
    if (!(star.electrons > 0.0)) continue;
    const StarLight light = smeared_star(scene, star, share);
    const Rectangle box = intersect(stamp_box(light.centre, light.half_width), {first, rows.y0, columns, rows.ny});
    if (box.empty()) continue;
    add_column_light(scene.psf(), light, rows, first, electrons_, scratch);
    along_x.assign(static_cast<std::size_t>(box.nx), 0.0);
    along_y.assign(static_cast<std::size_t>(box.nx), 0.0);
    add_column_gradient(scene.psf(), light, rows, box.x0, along_x, along_y, scratch);
    const AttitudeJacobian& j = star.motion;
    const auto begin = static_cast<std::size_t>(box.x0 - first);
    for (std::size_t i = 0; i < along_x.size(); ++i) {
      per_arcsec_[0][begin + i] += along_x[i] * j.dx_dyaw + along_y[i] * j.dy_dyaw;
      per_arcsec_[1][begin + i] += along_x[i] * j.dx_dpitch + along_y[i] * j.dy_dpitch;
      per_arcsec_[2][begin + i] += along_x[i] * j.dx_droll + along_y[i] * j.dy_droll;
    }
  }
  const double sky = smeared_sky(scene, rows.ny);
  for (int x = std::max(first, rows.x0); x < std::min(first + columns, rows.x1()); ++x)
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

namespace {

/// Rows of one half, counted from the one nearest to the register.
class RowsOfHalf {
 public:
  RowsOfHalf(const ReadoutNodes& nodes, const Rectangle& detector, int half)
      : half_(nodes.half(detector, half)), upwards_(half == 1) {}
  [[nodiscard]] const Rectangle& area() const { return half_; }
  [[nodiscard]] int number(int y) const { return upwards_ ? half_.y1() - 1 - y : y - half_.y0; }
  [[nodiscard]] int row(int number) const { return upwards_ ? half_.y1() - 1 - number : half_.y0 + number; }

 private:
  Rectangle half_;
  bool upwards_;
};

/// Adds what is missing to the rows of a region that lie in one half.
void add_missing(const Scene& scene, std::span<const StarLight> stars, double missing, const RowsOfHalf& rows,
                 const ImageView<float, unit::ExpectedElectrons>& view) {
  const Rectangle area = intersect(view.area(), rows.area());
  if (area.empty()) return;
  const auto width = static_cast<std::size_t>(area.nx);
  const int first = std::min(rows.number(area.y0), rows.number(area.y1() - 1));
  const int last = first + area.ny;
  // Light of each row from the first of the region on, the last one standing for all rows behind it.
  std::vector<double> light((static_cast<std::size_t>(area.ny) + 1) * width, 0.0);
  std::vector<double> fractions;
  for (const StarLight& star : stars) {
    const Rectangle box = intersect(intersect(stamp_box(star.centre, star.half_width), rows.area()),
                                    {area.x0, rows.area().y0, area.nx, rows.area().ny});
    if (box.empty()) continue;
    fractions.resize(box.size());
    scene.psf().integrate(star.centre, box, fractions);
    for (int y = box.y0; y < box.y1(); ++y) {
      const int number = rows.number(y);
      if (number < first) continue;
      double* row = light.data() + static_cast<std::size_t>(std::min(number, last) - first) * width;
      const double* fraction =
          fractions.data() + static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.nx);
      for (int x = box.x0; x < box.x1(); ++x) row[x - area.x0] += star.electrons * missing * fraction[x - box.x0];
    }
  }
  const double sky = smeared_sky(scene, rows.area().ny) * missing / std::max(1, rows.area().ny);
  for (std::size_t i = 0; i < width; ++i) {
    double behind = light[static_cast<std::size_t>(area.ny) * width + i];
    for (int number = last - 1; number >= first; --number) {
      // A packet sits in its own row for half of the step that begins the transfer, and of the one that ends it.
      const double own = light[static_cast<std::size_t>(number - first) * width + i];
      view.at(area.x0 + static_cast<int>(i), rows.row(number)) =
          static_cast<float>(behind + 0.5 * own + sky * (rows.area().ny - 0.5 - number));
      behind += own;
    }
  }
}

}  // namespace

Plane<float, unit::ExpectedElectrons> missing_from_behind(const Scene& scene,
                                                          const std::shared_ptr<const PixelLayout>& layout) {
  const SmearingSettings& smearing = scene.mission().ccd.smearing;
  const double missing = 1.0 - smearing.clear_time / smearing.time;
  if (smearing.model != SmearingModel::kFrameTransfer || missing == 0.0) return {};
  Plane<float, unit::ExpectedElectrons> result(layout);
  const ReadoutNodes nodes = readout_nodes(scene);
  for (int half = 0; half < nodes.halves(); ++half) {
    const RowsOfHalf rows(nodes, scene.detector(), half);
    std::vector<StarLight> stars;
    for (const SceneStar& star : scene.stars())
      if (star.electrons > 0.0) stars.push_back(smeared_star(scene, star, share_of(scene, rows.area().ny)));
    for (std::size_t r = 0; r < layout->exposed_regions().size(); ++r)
      add_missing(scene, stars, missing, rows, result.view(r));
  }
  return result;
}

std::vector<double> smeared_electrons(const Scene& scene, int half) {
  if (scene.mission().ccd.smearing.model == SmearingModel::kNone) return {};
  std::vector<double> electrons(static_cast<std::size_t>(scene.detector().nx));
  SmearedColumns(scene, 0, scene.detector().nx, half).at({}, mean_throughput(scene.mission()), 0, electrons);
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
