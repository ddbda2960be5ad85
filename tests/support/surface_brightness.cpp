#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "astroid/test/quadrature.hpp"

namespace astroid::test {

namespace {

using Row = std::vector<long double>;

// Second derivatives at the knots 0, 1, 2, … of the natural cubic spline through the values, 0 at both ends:
// m[k-1] + 4 m[k] + m[k+1] = 6 (y[k-1] - 2 y[k] + y[k+1]).
Row second_derivatives(const Row& values) {
  const std::size_t n = values.size();
  Row m(n, 0.0L);
  Row pivot(n, 0.0L);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const long double right = 6.0L * (values[k - 1] - 2.0L * values[k] + values[k + 1]);
    pivot[k] = 1.0L / (4.0L - (k > 1 ? pivot[k - 1] : 0.0L));
    m[k] = (right - m[k - 1]) * pivot[k];
  }
  for (std::size_t k = n - 2; k >= 1; --k) m[k] -= pivot[k] * m[k + 1];
  return m;
}

// What the derivative of a spline at u is, as weights of values and second derivatives at the knots on both sides.
struct Slope {
  std::size_t knot;
  std::array<long double, 2> values;  // at knot and knot + 1
  std::array<long double, 2> curvatures;
};

Slope slope_at(long double u, std::size_t intervals) {
  const auto knot =
      static_cast<std::size_t>(std::clamp(std::floor(u), 0.0L, static_cast<long double>(intervals) - 1.0L));
  const long double t = u - static_cast<long double>(knot);
  const long double s = 1.0L - t;
  return {knot, {-1.0L, 1.0L}, {(1.0L - 3.0L * s * s) / 6.0L, (3.0L * t * t - 1.0L) / 6.0L}};
}

// Running integral of a table at the corners of its samples, with its second derivatives along x, along y, and both.
struct Corners {
  std::vector<Row> value, along_x, along_y, along_both;  // [row][column]
};

std::vector<Row> along_columns(const std::vector<Row>& rows) {
  std::vector<Row> result(rows.size(), Row(rows[0].size()));
  for (std::size_t i = 0; i < rows[0].size(); ++i) {
    Row column;
    for (const Row& row : rows) column.push_back(row[i]);
    const Row m = second_derivatives(column);
    for (std::size_t j = 0; j < rows.size(); ++j) result[j][i] = m[j];
  }
  return result;
}

Corners corners_of(const PsfTable& table) {
  const auto nx = static_cast<std::size_t>(table.samples.nx());
  const auto ny = static_cast<std::size_t>(table.samples.ny());
  long double total = 0.0L;
  for (const double sample : table.samples.pixels()) total += static_cast<long double>(sample);
  Corners corners;
  corners.value.assign(ny + 1, Row(nx + 1, 0.0L));
  for (std::size_t j = 0; j < ny; ++j) {
    long double row = 0.0L;
    for (std::size_t i = 0; i < nx; ++i) {
      row += static_cast<long double>(table.samples.pixels()[j * nx + i]) / total;
      corners.value[j + 1][i + 1] = corners.value[j][i + 1] + row;
    }
  }
  for (const Row& row : corners.value) corners.along_x.push_back(second_derivatives(row));
  corners.along_y = along_columns(corners.value);
  corners.along_both = along_columns(corners.along_x);
  return corners;
}

std::vector<long double> knots(std::size_t samples, double centre, double samples_per_pixel) {
  std::vector<long double> at;
  for (std::size_t k = 0; k <= samples; ++k)
    at.push_back((static_cast<long double>(k) - 0.5L - static_cast<long double>(centre)) /
                 static_cast<long double>(samples_per_pixel));
  return at;
}

// Ends of the pieces of [from, to] between the breaks.
std::vector<long double> pieces(long double from, long double to, const std::vector<long double>& breaks) {
  std::vector<long double> ends = {from};
  for (const long double at : breaks)
    if (at > from && at < to) ends.push_back(at);
  ends.push_back(to);
  return ends;
}

}  // namespace

SurfaceBrightness smooth_brightness(Density density) {
  return {std::move(density), {}, {}};
}

SurfaceBrightness faded_brightness(Density density, long double reach) {
  const long double softness = std::min(0.5L, reach / 24.0L);
  const std::vector<long double> ends = {-reach, reach};
  return {[density = std::move(density), reach, softness](long double dx, long double dy) {
            const long double r = std::hypot(dx, dy);
            const long double edge = (r - reach + 6.0L * softness) / (std::sqrt(2.0L) * softness);
            return r < reach ? 0.5L * std::erfc(edge) * density(dx, dy) : 0.0L;
          },
          ends, ends};
}

SurfaceBrightness table_brightness(const PsfTable& table) {
  const auto nx = static_cast<std::size_t>(table.samples.nx());
  const auto ny = static_cast<std::size_t>(table.samples.ny());
  const auto scale = static_cast<long double>(table.samples_per_pixel);
  const auto x_edge = static_cast<long double>(table.centre_x) + 0.5L;
  const auto y_edge = static_cast<long double>(table.centre_y) + 0.5L;
  const Corners corners = corners_of(table);
  const auto density = [=](long double dx, long double dy) {
    const long double u = dx * scale + x_edge;
    const long double v = dy * scale + y_edge;
    if (u < 0.0L || v < 0.0L || u > static_cast<long double>(nx) || v > static_cast<long double>(ny)) return 0.0L;
    const Slope x = slope_at(u, nx);
    const Slope y = slope_at(v, ny);
    long double sum = 0.0L;
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t row = y.knot + j;
        const std::size_t column = x.knot + i;
        sum +=
            y.values[j] * (x.values[i] * corners.value[row][column] + x.curvatures[i] * corners.along_x[row][column]) +
            y.curvatures[j] *
                (x.values[i] * corners.along_y[row][column] + x.curvatures[i] * corners.along_both[row][column]);
      }
    return sum * scale * scale;
  };
  return {density, knots(nx, table.centre_x, table.samples_per_pixel),
          knots(ny, table.centre_y, table.samples_per_pixel)};
}

Area area_of(const Rectangle& pixels) {
  const long double x0 = static_cast<long double>(pixels.x0) - 0.5L;
  const long double y0 = static_cast<long double>(pixels.y0) - 0.5L;
  return {x0, x0 + pixels.nx, y0, y0 + pixels.ny};
}

Integral integrate_area(const SurfaceBrightness& brightness, PixelPosition star, const Area& area,
                        long double absolute) {
  const auto x = static_cast<long double>(star.x);
  const auto y = static_cast<long double>(star.y);
  const auto columns = pieces(area.x0 - x, area.x1 - x, brightness.x_breaks);
  const auto rows = pieces(area.y0 - y, area.y1 - y, brightness.y_breaks);
  // A panel of the outer integral is as good as the inner ones it is made of, so these are asked for a tenth.
  constexpr long double kInner = 0.1L;
  Integral sum;
  for (std::size_t j = 0; j + 1 < rows.size(); ++j)
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      const long double share = absolute / static_cast<long double>((rows.size() - 1) * (columns.size() - 1));
      long double worst_inner = 0.0L;
      const auto row = [&](long double dy) {
        const Integral inner = integrate_absolute([&](long double dx) { return brightness.density(dx, dy); },
                                                  columns[i], columns[i + 1], kInner * share);
        worst_inner = std::max(worst_inner, inner.error);
        return inner.value;
      };
      Integral piece = integrate_absolute(row, rows[j], rows[j + 1], share);
      piece.error += worst_inner * (rows[j + 1] - rows[j]);
      sum += piece;
    }
  return sum;
}

Integral integrate_response(const SurfaceBrightness& brightness, const PixelResponse& response, PixelPosition star,
                            int x, int y, long double absolute) {
  const long double size = 1.0L / response.cells;
  Integral sum;
  for (int j = 0; j < response.cells; ++j)
    for (int i = 0; i < response.cells; ++i) {
      const long double x0 = static_cast<long double>(x) - 0.5L + static_cast<long double>(i) * size;
      const long double y0 = static_cast<long double>(y) - 0.5L + static_cast<long double>(j) * size;
      const Integral cell = integrate_area(brightness, star, {x0, x0 + size, y0, y0 + size}, absolute);
      const auto weight = static_cast<long double>(response.at(i, j));
      sum += {weight * cell.value, weight * cell.error};
    }
  return sum;
}

}  // namespace astroid::test
