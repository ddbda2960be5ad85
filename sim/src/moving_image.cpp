#include "astroid/sim/moving_image.hpp"

#include <algorithm>
#include <utility>

#include "astroid/core/plane_kernels.hpp"

namespace astroid {

namespace {
/// Motions that go back and forth stay within a few cells, and drift leaves them behind. So many are kept, or as many
/// as fit into this memory, but always the two at a border.
constexpr std::size_t kMostCells = 9;
constexpr double kMostBytes = 512.0 * 1024.0 * 1024.0;

std::size_t most_cells(const AttitudePolynomial& polynomial, std::size_t pixels) {
  const std::size_t pixel = sizeof(double) + (polynomial.terms.size() - 1) * sizeof(float);
  const double fit = kMostBytes / (static_cast<double>(pixel) * static_cast<double>(std::max<std::size_t>(1, pixels)));
  return static_cast<std::size_t>(std::clamp(fit, 2.0, static_cast<double>(kMostCells)));
}
}  // namespace

MovingImage::MovingImage(AttitudePolynomial polynomial, std::size_t pixels)
    : polynomial_(std::move(polynomial)),
      inverse_(coefficients_from_values(polynomial_)),
      cells_(most_cells(polynomial_, pixels)) {}

MovingImageCell MovingImage::make_cell(const Attitude& centre, const RenderAt& render) const {
  const std::vector<MotionPoint> points = interpolation_points(polynomial_, centre);
  const std::size_t n = points.size();
  // One image after the other is rendered and added to every coefficient, so few are held at a time.
  std::vector<Plane<double, unit::ExpectedElectrons>> coefficients;
  for (std::size_t point = 0; point < n; ++point) {
    const Plane<double, unit::ExpectedElectrons> image = render(points[point]);
    for (std::size_t t = 0; t < n; ++t) {
      if (point == 0) coefficients.emplace_back(image.shared_layout());
      const double weight = inverse_[t * n + point];
      if (weight == 0.0) continue;
      const std::span<double> sum = coefficients[t].pixels();
      const std::span<const double> values = image.pixels();
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * values[i];
    }
  }
  MovingImageCell cell;
  cell.base = std::move(coefficients[0]);
  for (std::size_t t = 1; t < n; ++t) {
    Plane<float, unit::ExpectedElectrons>& map = cell.maps.emplace_back(cell.base.shared_layout());
    const std::span<const double> values = std::as_const(coefficients[t]).pixels();
    for (std::size_t i = 0; i < values.size(); ++i) map.pixels()[i] = static_cast<float>(values[i]);
  }
  return cell;
}

std::vector<float> exposure_weights(const AttitudePolynomial& polynomial, std::span<const Attitude> attitudes,
                                    double time) {
  const Attitude centre = cell_centre(polynomial, attitude_moments(attitudes).mean);
  const std::vector<double> terms = mean_of_terms(polynomial, centre, attitudes, time);
  std::vector<float> weights;
  for (std::size_t t = 1; t < terms.size(); ++t) weights.push_back(static_cast<float>(terms[t]));
  return weights;
}

MovingImage::Exposure MovingImage::exposure(std::int64_t epoch, const Attitude& mean, std::span<const float> weights,
                                            const RenderAt& render) const {
  const Attitude centre = cell_centre(polynomial_, mean);
  const Key key{.epoch = epoch, .centre = {centre.yaw, centre.pitch, centre.roll}};
  return {.cell = cells_.get(key, [&] { return make_cell(centre, render); }), .weights = weights};
}

void MovingImage::Exposure::recall(const Strip& strip, std::span<double> expected) const {
  std::vector<const float*> maps;
  maps.reserve(cell->maps.size());
  for (const auto& map : cell->maps) maps.push_back(map.pixels().data() + strip.begin);
  combine_maps(cell->base.pixels().subspan(strip.begin, strip.size()), maps, weights, expected);
}

}  // namespace astroid
