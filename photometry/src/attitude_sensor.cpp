#include "astroid/photometry/attitude_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "small_matrix.hpp"
#include "star_light.hpp"

namespace astroid {

namespace {

using detail::kGradientStep;

constexpr unsigned kUnusable = pixel_flag::kFullWell | pixel_flag::kAdcSaturated | pixel_flag::kBad;
// Two degrees of freedom beyond which a guide star is not believed: exp(-25 / 2) is 4e-6.
constexpr double kOutlier = 25.0;

using Symmetric3 = std::array<double, 6>;  // xx, xy, xz, yy, yz, zz

/// Adds weight (a b^T + b a^T) / 2.
void add_product(Symmetric3& sum, double weight, const std::array<double, 3>& a, const std::array<double, 3>& b) {
  std::size_t element = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i; j < a.size(); ++j) sum[element++] += 0.5 * weight * (a[i] * b[j] + a[j] * b[i]);
}

std::array<double, 3> product(const std::array<double, 9>& m, const std::array<double, 3>& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

std::array<double, 3> row_x(const AttitudeJacobian& j) {
  return {j.dx_dyaw, j.dx_dpitch, j.dx_droll};
}

std::array<double, 3> row_y(const AttitudeJacobian& j) {
  return {j.dy_dyaw, j.dy_dpitch, j.dy_droll};
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// In units of the reach of each axis.
AttitudeJacobian scaled(const AttitudeJacobian& j, const Attitude& reach) {
  return {.dx_dyaw = j.dx_dyaw * reach.yaw,
          .dx_dpitch = j.dx_dpitch * reach.pitch,
          .dx_droll = j.dx_droll * reach.roll,
          .dy_dyaw = j.dy_dyaw * reach.yaw,
          .dy_dpitch = j.dy_dpitch * reach.pitch,
          .dy_droll = j.dy_droll * reach.roll};
}

}  // namespace

/// The normal equations of the attitude in units of the reach.
struct AttitudeSensor::Normal {
  Symmetric3 matrix{1.0, 0.0, 0.0, 1.0, 0.0, 1.0};  // the prior, to which the stars add: it always has an inverse
  std::array<double, 3> right{};
  std::size_t guides = 0;
};

AttitudeSensor::AttitudeSensor(const PixelLayout& layout, const GroundModel& model, const PhotometrySettings& settings,
                               std::span<const GuideStar> guides, const Attitude& reach)
    : reach_(reach), gain_(model.gain.value()) {
  const std::vector<Rectangle> stamps = detail::star_stamps(model, settings);
  std::vector<Rectangle> windows;
  windows.reserve(guides.size());
  for (const GuideStar& guide : guides)
    windows.push_back(mask_window(model.stars[guide.star].position, settings.mask_window));
  const detail::Overlaps overlaps = detail::stamps_on_windows(stamps, windows);
  std::vector<Rectangle> used;
  std::vector<double> light;
  std::vector<double> along_x;
  std::vector<double> along_y;
  std::vector<double> scratch;
  for (std::size_t g = 0; g < guides.size(); ++g) {
    const Rectangle& window = windows[g];
    const auto region = std::find_if(layout.exposed_regions().begin(), layout.exposed_regions().end(),
                                     [&](const Rectangle& r) { return intersect(window, r) == window; });
    const bool shares_pixels =
        std::any_of(used.begin(), used.end(), [&](const Rectangle& u) { return !intersect(window, u).empty(); });
    if (window.empty() || region == layout.exposed_regions().end() || shares_pixels) continue;
    used.push_back(window);
    for (std::vector<double>* map : {&light, &along_x, &along_y}) map->assign(window.size(), 0.0);
    for (std::size_t k = overlaps.first[g]; k < overlaps.first[g + 1]; ++k) {
      const std::size_t index = overlaps.star[k];
      const FieldStar& star = model.stars[index];
      detail::add_star(*model.psf, star, stamps[index], window, light, scratch);
      detail::add_change(*model.psf, star, stamps[index], window, true, along_x, scratch);
      detail::add_change(*model.psf, star, stamps[index], window, false, along_y, scratch);
    }
    for (double& change : along_x) change /= 2.0 * kGradientStep;
    for (double& change : along_y) change /= 2.0 * kGradientStep;
    const auto width = static_cast<std::size_t>(region->nx);
    const auto first = layout.offset(static_cast<std::size_t>(region - layout.regions().begin())) +
                       static_cast<std::size_t>(window.y0 - region->y0) * width +
                       static_cast<std::size_t>(window.x0 - region->x0);
    add_guide(guides[g], window, first, width, light, along_x, along_y, model.noise);
  }
}

void AttitudeSensor::add_guide(const GuideStar& guide, const Rectangle& window, std::size_t first_pixel,
                               std::size_t width, std::span<const double> light, std::span<const double> along_x,
                               std::span<const double> along_y, const PixelNoise& noise) {
  // Sums over the pixels, each divided by its variance, of products of light (l), one, and the derivatives (x, y).
  double ll = 0.0, l1 = 0.0, ones = 0.0, lx = 0.0, ly = 0.0, x1 = 0.0, y1 = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double variance = noise.variance(light[i]);
    if (!(variance > 0.0)) return;  // a noiseless pixel decides everything: nothing is known of its error
    const double weight = 1.0 / variance;
    ll += weight * light[i] * light[i];
    l1 += weight * light[i];
    ones += weight;
    lx += weight * light[i] * along_x[i];
    ly += weight * light[i] * along_y[i];
    x1 += weight * along_x[i];
    y1 += weight * along_y[i];
    xx += weight * along_x[i] * along_x[i];
    xy += weight * along_x[i] * along_y[i];
    yy += weight * along_y[i] * along_y[i];
  }
  const double determinant = ll * ones - l1 * l1;
  if (!(determinant > 1e-9 * ll * ones)) return;  // the star can't be told from the background
  // What of each derivative looks like more flux (a) or more background (b).
  const double ax = (ones * lx - l1 * x1) / determinant;
  const double bx = (ll * x1 - l1 * lx) / determinant;
  const double ay = (ones * ly - l1 * y1) / determinant;
  const double by = (ll * y1 - l1 * ly) / determinant;
  Guide added{.begin = pixels_.size(),
              .end = pixels_.size() + light.size(),
              .motion = scaled(guide.motion, reach_),
              .xx = xx - ax * lx - bx * x1,
              .xy = xy - ax * ly - bx * y1,
              .yy = yy - ay * ly - by * y1};
  if (!(added.xx > 0.0 && added.xx * added.yy - added.xy * added.xy > 1e-9 * added.xx * added.yy)) return;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double weight = 1.0 / noise.variance(light[i]);
    const auto row = i / static_cast<std::size_t>(window.nx);
    const auto column = i % static_cast<std::size_t>(window.nx);
    pixels_.push_back({.index = static_cast<std::uint32_t>(first_pixel + row * width + column),
                       .x = weight * (along_x[i] - ax * light[i] - bx),
                       .y = weight * (along_y[i] - ay * light[i] - by)});
  }
  guides_.push_back(added);
}

AttitudeSensor::Displacement AttitudeSensor::read(const Guide& guide, const Frame& frame) const {
  const std::span<const float> counts = frame.pixels.pixels();
  const std::span<const std::uint8_t> flags = frame.flags.pixels();
  Displacement sum{.good = true};
  unsigned found = 0;
  for (std::size_t i = guide.begin; i < guide.end; ++i) {
    const Pixel& pixel = pixels_[i];
    const auto value = static_cast<double>(counts[pixel.index]);
    sum.x += pixel.x * value;
    sum.y += pixel.y * value;
    found |= flags[pixel.index];
  }
  sum.x *= gain_;
  sum.y *= gain_;
  sum.good = (found & kUnusable) == 0 && std::isfinite(sum.x) && std::isfinite(sum.y);
  return sum;
}

AttitudeSensor::Normal AttitudeSensor::normal(std::span<const Displacement> displacements) const {
  Normal sum;
  for (std::size_t g = 0; g < guides_.size(); ++g) {
    if (!displacements[g].good) continue;
    const Guide& guide = guides_[g];
    const std::array<double, 3> x = row_x(guide.motion);
    const std::array<double, 3> y = row_y(guide.motion);
    add_product(sum.matrix, guide.xx, x, x);
    add_product(sum.matrix, 2.0 * guide.xy, x, y);
    add_product(sum.matrix, guide.yy, y, y);
    for (std::size_t k = 0; k < x.size(); ++k) sum.right[k] += x[k] * displacements[g].x + y[k] * displacements[g].y;
    ++sum.guides;
  }
  return sum;
}

double AttitudeSensor::contradiction(const Guide& guide, const Displacement& measured,
                                     const std::array<double, 3>& attitude) const {
  const double dx = dot(row_x(guide.motion), attitude);
  const double dy = dot(row_y(guide.motion), attitude);
  const double x = measured.x - guide.xx * dx - guide.xy * dy;
  const double y = measured.y - guide.xy * dx - guide.yy * dy;
  return (guide.yy * x * x - 2.0 * guide.xy * x * y + guide.xx * y * y) / (guide.xx * guide.yy - guide.xy * guide.xy);
}

MeasuredAttitude AttitudeSensor::measure(const Frame& frame) const {
  std::vector<Displacement> displacements;
  displacements.reserve(guides_.size());
  for (const Guide& guide : guides_) displacements.push_back(read(guide, frame));
  // One after the other, the worst first: a bright particle makes good stars look bad as well.
  for (std::size_t round = 0;; ++round) {
    const Normal equations = normal(displacements);
    const std::array<double, 3> attitude = product(detail::inverse_of_symmetric(equations.matrix), equations.right);
    double worst = kOutlier;
    Displacement* outlier = nullptr;
    for (std::size_t g = 0; g < guides_.size(); ++g) {
      if (!displacements[g].good) continue;
      const double chi2 = contradiction(guides_[g], displacements[g], attitude);
      if (!(chi2 > worst)) continue;
      worst = chi2;
      outlier = &displacements[g];
    }
    if (outlier == nullptr || 2 * round >= guides_.size())
      return {.mean = {.yaw = attitude[0] * reach_.yaw,
                       .pitch = attitude[1] * reach_.pitch,
                       .roll = attitude[2] * reach_.roll},
              .guides = equations.guides};
    outlier->good = false;
  }
}

AttitudeCovariance AttitudeSensor::covariance() const {
  const std::vector<Displacement> all(guides_.size(), Displacement{.good = true});
  const std::array<double, 9> c = detail::inverse_of_symmetric(normal(all).matrix);
  const Attitude& r = reach_;
  return {.yaw_yaw = c[0] * r.yaw * r.yaw,
          .yaw_pitch = c[1] * r.yaw * r.pitch,
          .yaw_roll = c[2] * r.yaw * r.roll,
          .pitch_pitch = c[4] * r.pitch * r.pitch,
          .pitch_roll = c[5] * r.pitch * r.roll,
          .roll_roll = c[8] * r.roll * r.roll};
}

}  // namespace astroid
