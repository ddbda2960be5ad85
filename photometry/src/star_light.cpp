#include "star_light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "cell_grid.hpp"

namespace astroid::detail {

namespace {

// Decades of lost fraction that are told apart; what is asked beyond the last gets the last.
constexpr int kDecades = 16;
// Farther from the origin than any detector reaches, px.
constexpr double kFarthestPosition = 1e6;

}  // namespace

bool shines(const FieldStar& star) {
  return std::abs(star.position.x) < kFarthestPosition && std::abs(star.position.y) < kFarthestPosition &&
         star.electrons > 0.0 && std::isfinite(star.electrons);
}

StampSizes::StampSizes(const PixelPsf& psf, double lost_electrons, double fixed)
    : psf_(psf),
      lost_electrons_(lost_electrons),
      fixed_(fixed),
      by_decade_(kDecades, std::numeric_limits<double>::quiet_NaN()) {}

double StampSizes::half_width(double electrons) {
  if (fixed_ > 0.0) return fixed_;
  // The smallest decade d with 10^-d e- lost or less, found without logarithms so that it is the same everywhere.
  int decade = 1;
  double lost = 0.1;
  while (decade < kDecades - 1 && lost * electrons > lost_electrons_) {
    ++decade;
    lost *= 0.1;
  }
  double& half_width = by_decade_[static_cast<std::size_t>(decade)];
  if (std::isnan(half_width)) half_width = psf_.stamp_half_width(lost);
  return half_width;
}

std::vector<Rectangle> star_stamps(const GroundModel& model, const PhotometrySettings& settings) {
  double faintest = std::numeric_limits<double>::infinity();
  for (const std::size_t target : model.targets)
    if (shines(model.stars[target])) faintest = std::min(faintest, model.stars[target].electrons);
  std::vector<Rectangle> stamps(model.stars.size());
  if (!std::isfinite(faintest)) return stamps;
  if (model.faintest_electrons > 0.0) faintest = model.faintest_electrons;
  StampSizes sizes(*model.psf, model.accuracy * faintest, settings.mask_reach.value());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const FieldStar& star = model.stars[i];
    if (shines(star)) stamps[i] = stamp_box(star.position, sizes.half_width(star.electrons));
  }
  return stamps;
}

Overlaps stamps_on_windows(std::span<const Rectangle> stamps, std::span<const Rectangle> windows) {
  const CellGrid grid(windows);
  std::vector<std::size_t> touched;
  Overlaps overlaps;
  overlaps.first.assign(windows.size() + 1, 0);
  for (const Rectangle& stamp : stamps) {
    grid.find(stamp, touched);
    for (const std::size_t window : touched) ++overlaps.first[window + 1];
  }
  for (std::size_t i = 0; i < windows.size(); ++i) overlaps.first[i + 1] += overlaps.first[i];
  overlaps.star.resize(overlaps.first.back());
  std::vector<std::size_t> next(overlaps.first.begin(), overlaps.first.end() - 1);
  for (std::size_t star = 0; star < stamps.size(); ++star) {
    grid.find(stamps[star], touched);
    for (const std::size_t window : touched) overlaps.star[next[window]++] = star;
  }
  return overlaps;
}

void add_star(const PixelPsf& psf, const FieldStar& star, const Rectangle& stamp, const Rectangle& box,
              std::span<double> light, std::vector<double>& scratch) {
  const Rectangle common = intersect(stamp, box);
  if (common.empty()) return;
  scratch.resize(common.size());
  psf.integrate(star.position, common, scratch);
  const auto width = static_cast<std::size_t>(common.nx);
  for (int y = common.y0; y < common.y1(); ++y) {
    const double* from = scratch.data() + static_cast<std::size_t>(y - common.y0) * width;
    double* to = light.data() + static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.nx) +
                 static_cast<std::size_t>(common.x0 - box.x0);
    for (std::size_t i = 0; i < width; ++i) to[i] += star.electrons * from[i];
  }
}

void add_change(const PixelPsf& psf, const FieldStar& star, const Rectangle& stamp, const Rectangle& box, bool along_x,
                std::span<double> light, std::vector<double>& scratch) {
  for (const double sign : {1.0, -1.0}) {
    FieldStar moved{.id = {}, .position = star.position, .electrons = sign * star.electrons};
    (along_x ? moved.position.x : moved.position.y) += sign * kGradientStep;
    add_star(psf, moved, stamp, box, light, scratch);
  }
}

Plane<double, unit::ExpectedElectrons> expected_light(const PixelLayout& layout, const GroundModel& model,
                                                      std::span<const Rectangle> stamps) {
  Plane<double, unit::ExpectedElectrons> light(std::make_shared<const PixelLayout>(layout));
  const CellGrid grid(layout.regions());
  std::vector<std::size_t> touched;
  std::vector<double> scratch;
  for (std::size_t star = 0; star < stamps.size(); ++star) {
    grid.find(stamps[star], touched);
    for (const std::size_t region : touched) {
      const Rectangle& box = layout.regions()[region];
      add_star(*model.psf, model.stars[star], stamps[star], box,
               light.pixels().subspan(layout.offset(region), box.size()), scratch);
    }
  }
  return light;
}

}  // namespace astroid::detail
