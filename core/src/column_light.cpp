#include "astroid/core/column_light.hpp"

#include <cstddef>

namespace astroid {

namespace {

/// The part of a star's stamp that falls on the given columns of the detector.
Rectangle part_on_columns(const StarLight& star, const Rectangle& detector, int x0, std::size_t columns) {
  const Rectangle asked{x0, detector.y0, static_cast<int>(columns), detector.ny};
  return intersect(intersect(stamp_box(star.centre, star.half_width), detector), asked);
}

/// Adds factor × the sum over rows of the values of a box.
void add_rows(const Rectangle& box, std::span<const double> values, double factor, int x0, std::span<double> columns) {
  const auto width = static_cast<std::size_t>(box.nx);
  const auto first = static_cast<std::size_t>(box.x0 - x0);
  for (std::size_t i = 0; i < width; ++i) {
    double sum = 0.0;
    for (std::size_t k = i; k < box.size(); k += width) sum += values[k];
    columns[first + i] += factor * sum;
  }
}

}  // namespace

void add_column_light(const PixelPsf& psf, const StarLight& star, const Rectangle& detector, int x0,
                      std::span<double> columns, std::vector<double>& scratch) {
  const Rectangle box = part_on_columns(star, detector, x0, columns.size());
  if (box.empty()) return;
  if (scratch.size() < box.size()) scratch.resize(box.size());
  const std::span<double> fractions = std::span(scratch).first(box.size());
  psf.integrate(star.centre, box, fractions);
  add_rows(box, fractions, star.electrons, x0, columns);
}

void add_column_gradient(const PixelPsf& psf, const StarLight& star, const Rectangle& detector, int x0,
                         std::span<double> along_x, std::span<double> along_y, std::vector<double>& scratch) {
  const Rectangle box = part_on_columns(star, detector, x0, along_x.size());
  if (box.empty()) return;
  if (scratch.size() < 2 * box.size()) scratch.resize(2 * box.size());
  const std::span<double> dpdx = std::span(scratch).first(box.size());
  const std::span<double> dpdy = std::span(scratch).subspan(box.size(), box.size());
  psf.integrate_gradient(star.centre, box, dpdx, dpdy);
  add_rows(box, dpdx, star.electrons, x0, along_x);
  add_rows(box, dpdy, star.electrons, x0, along_y);
}

double clocking_share(double seconds, double exposure, int rows) {
  return rows > 0 && exposure > 0.0 ? seconds / (static_cast<double>(rows) * exposure) : 0.0;
}

}  // namespace astroid
