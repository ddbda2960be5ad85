#include "astroid/photometry/background.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/photometry/aperture.hpp"
#include "natural_spline.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check(const MeshSettings& settings) {
  std::vector<Problem> problems;
  const auto complain = [&problems](const char* parameter, double value, const char* expected) {
    Problem problem;
    problem.parameter = parameter;
    problem.value = fmt::format("{}", value);
    problem.expected = expected;
    problem.message = "the background mesh cannot be made";
    problems.push_back(std::move(problem));
  };
  if (settings.cell < 1) complain("Photometry/Mesh", settings.cell, "at least 1 px");
  if (settings.filter < 1) complain("mesh filter", settings.filter, "at least 1 cell");
  if (!(settings.clip > 0.0)) complain("mesh clip", settings.clip, "more than 0 sigma");
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::size_t cells_along(int pixels, int cell) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(static_cast<double>(pixels) / cell + 0.5)));
}

// First pixel of cell i of n along an axis of `pixels`.
int cell_edge(std::size_t i, std::size_t n, int pixels) {
  return static_cast<int>(i * static_cast<std::size_t>(pixels) / n);
}

bool usable(float counts, std::uint8_t flags) {
  return (flags & ~pixel_flag::kTruth) == 0 && std::isfinite(counts);
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? kNaN : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

BackgroundMap::BackgroundMap(const Frame& frame, std::size_t region, const MeshSettings& settings)
    : area_(frame.pixels.layout().regions()[region]) {
  check(settings);
  columns_ = cells_along(area_.nx, settings.cell);
  rows_ = cells_along(area_.ny, settings.cell);
  const auto pixels = frame.pixels.view(region);
  const auto flags = frame.flags.view(region);
  std::vector<double> level(columns_ * rows_, kNaN);
  std::vector<double> rms(columns_ * rows_, kNaN);
  std::vector<double> values;
  for (std::size_t j = 0; j < rows_; ++j) {
    for (std::size_t i = 0; i < columns_; ++i) {
      const int x0 = cell_edge(i, columns_, area_.nx);
      const int x1 = cell_edge(i + 1, columns_, area_.nx);
      const int y0 = cell_edge(j, rows_, area_.ny);
      const int y1 = cell_edge(j + 1, rows_, area_.ny);
      values.clear();
      for (int y = y0; y < y1; ++y) {
        const auto row = pixels.row(area_.y0 + y);
        const auto row_flags = flags.row(area_.y0 + y);
        for (auto x = static_cast<std::size_t>(x0); x < static_cast<std::size_t>(x1); ++x)
          if (usable(row[x], row_flags[x])) values.push_back(static_cast<double>(row[x]));
      }
      const auto all = static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0);
      if (values.empty() || 2 * values.size() < all) continue;
      const SkyEstimate sky = clipped_sky(values, settings.clip, true);
      level[j * columns_ + i] = sky.level;
      rms[j * columns_ + i] = sky.rms;
    }
  }
  for (std::vector<double>* cells : {&level, &rms}) {
    fill_empty_cells(*cells);
    filter_cells(*cells, settings.filter);
  }
  median_level_ = median_of(level);
  median_rms_ = median_of(rms);
  level_ = make_grid(std::move(level));
  rms_ = make_grid(std::move(rms));
}

void BackgroundMap::fill_empty_cells(std::vector<double>& value) const {
  const std::vector<double> given = value;
  const auto columns = static_cast<int>(columns_);
  const auto rows = static_cast<int>(rows_);
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(j) * columns_ + static_cast<std::size_t>(i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (!std::isnan(given[at(i, j)])) continue;
      // The mean of the nearest square ring of cells that has any.
      for (int ring = 1; ring < std::max(columns, rows) && std::isnan(value[at(i, j)]); ++ring) {
        double sum = 0.0;
        int count = 0;
        for (int b = std::max(0, j - ring); b <= std::min(rows - 1, j + ring); ++b) {
          for (int a = std::max(0, i - ring); a <= std::min(columns - 1, i + ring); ++a) {
            if (std::max(std::abs(a - i), std::abs(b - j)) != ring || std::isnan(given[at(a, b)])) continue;
            sum += given[at(a, b)];
            ++count;
          }
        }
        if (count > 0) value[at(i, j)] = sum / count;
      }
    }
  }
}

void BackgroundMap::filter_cells(std::vector<double>& value, int side) const {
  const std::vector<double> given = value;
  const auto columns = static_cast<int>(columns_);
  const auto rows = static_cast<int>(rows_);
  const int half = side / 2;
  std::vector<double> near;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      near.clear();
      // The window shrinks symmetrically at the edges, so that a gradient passes unchanged.
      const int half_x = std::min({half, i, columns - 1 - i});
      const int half_y = std::min({half, j, rows - 1 - j});
      for (int b = j - half_y; b <= j + half_y; ++b)
        for (int a = i - half_x; a <= i + half_x; ++a)
          near.push_back(given[static_cast<std::size_t>(b) * columns_ + static_cast<std::size_t>(a)]);
      // After filling, either every cell has a value or none has.
      value[static_cast<std::size_t>(j) * columns_ + static_cast<std::size_t>(i)] =
          std::isnan(near.front()) ? kNaN : median_of(near);
    }
  }
}

BackgroundMap::Grid BackgroundMap::make_grid(std::vector<double> value) const {
  Grid grid{std::move(value), {}};
  grid.curvature.assign(grid.value.size(), 0.0);
  std::vector<double> scratch;
  for (std::size_t i = 0; i < columns_; ++i)
    detail::natural_spline(std::span<const double>(grid.value).subspan(i), columns_,
                           std::span<double>(grid.curvature).subspan(i), scratch);
  return grid;
}

void BackgroundMap::grid_row(const Grid& grid, int y, std::span<double> out) const {
  const double cell_height = static_cast<double>(area_.ny) / static_cast<double>(rows_);
  const double cell_width = static_cast<double>(area_.nx) / static_cast<double>(columns_);
  const double v = (y - area_.y0 + 0.5) / cell_height - 0.5;
  std::vector<double> knots(columns_);
  for (std::size_t i = 0; i < columns_; ++i)
    knots[i] = detail::spline_value(std::span<const double>(grid.value).subspan(i),
                                    std::span<const double>(grid.curvature).subspan(i), columns_, v);
  std::vector<double> curvature(columns_);
  std::vector<double> scratch;
  detail::natural_spline(knots, 1, curvature, scratch);
  for (std::size_t x = 0; x < out.size(); ++x)
    out[x] = detail::spline_value(knots, curvature, 1, (static_cast<double>(x) + 0.5) / cell_width - 0.5);
}

void BackgroundMap::level_row(int y, std::span<double> level) const {
  grid_row(level_, y, level);
}

void BackgroundMap::rms_row(int y, std::span<double> rms) const {
  grid_row(rms_, y, rms);
  // Between very different cells a spline can undershoot; a scatter is never negative.
  for (double& value : rms) value = value < 0.0 ? 0.0 : value;
}

void subtract_background(Frame& frame, std::size_t region, const BackgroundMap& background) {
  const auto pixels = frame.pixels.view(region);
  std::vector<double> level(static_cast<std::size_t>(pixels.nx()));
  for (int y = pixels.area().y0; y < pixels.area().y1(); ++y) {
    background.level_row(y, level);
    const auto row = pixels.row(y);
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = static_cast<float>(static_cast<double>(row[i]) - (level[i] - frame.header.bias.value()));
  }
}

AnnulusBackground annulus_background(const Frame& frame, std::size_t region, PixelPosition centre, double inner,
                                     double outer) {
  constexpr double kClip = 3.0;
  AnnulusBackground result;
  result.level = kNaN;
  result.error = kNaN;
  result.rms = kNaN;
  const auto pixels = frame.pixels.view(region);
  const auto flags = frame.flags.view(region);
  const Rectangle box = intersect(aperture_box(centre, outer), pixels.area());
  std::vector<double> values;
  for (int y = box.y0; y < box.y1(); ++y) {
    for (int x = box.x0; x < box.x1(); ++x) {
      const double dx = x - centre.x;
      const double dy = y - centre.y;
      const double square = dx * dx + dy * dy;
      if (square < inner * inner || square > outer * outer || !usable(pixels.at(x, y), flags.at(x, y))) continue;
      values.push_back(static_cast<double>(pixels.at(x, y)));
    }
  }
  const SkyEstimate sky = clipped_sky(values, kClip, false);
  result.pixels = sky.pixels;
  if (sky.pixels < kFewestAnnulusPixels) return result;
  result.level = sky.level;
  result.rms = sky.rms;
  result.error = std::sqrt(0.5 * kPi / static_cast<double>(sky.pixels)) * sky.rms;
  return result;
}

}  // namespace astroid
