#include "astroid/photometry/background.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/photometry/aperture.hpp"
#include "mesh/cell_histogram.hpp"
#include "mesh/light_under_sky.hpp"
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

constexpr std::size_t kBlock = 4;  // cells along a side of a block whose pixels tell how much light of stars is in it

bool usable(float counts, std::uint8_t flags) {
  return (flags & ~pixel_flag::kTruth) == 0 && std::isfinite(counts);
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? kNaN : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

// What the cells of a mesh say before it is smoothed.
struct BackgroundMap::Cells {
  std::vector<double> level, mode, rms;     // shape (rows, columns), ADU; NaN without enough pixels
  std::vector<std::vector<double>> blocks;  // counts about the level of each cell in units of its rms
  std::size_t block_columns = 0;
  std::size_t block_rows = 0;
};

BackgroundMap::BackgroundMap(const Frame& frame, std::size_t region, const MeshSettings& settings)
    : area_(frame.pixels.layout().regions()[region]) {
  check(settings);
  columns_ = cells_along(area_.nx, settings.cell);
  rows_ = cells_along(area_.ny, settings.cell);
  const auto pixels = frame.pixels.view(region);
  const auto flags = frame.flags.view(region);
  const bool fit_light = settings.estimator == SkyEstimator::kLightFit;
  Cells cells;
  cells.level.assign(columns_ * rows_, kNaN);
  cells.mode = cells.level;
  cells.rms = cells.level;
  cells.block_columns = (columns_ + kBlock - 1) / kBlock;
  cells.block_rows = (rows_ + kBlock - 1) / kBlock;
  cells.blocks.assign(cells.block_columns * cells.block_rows, std::vector<double>(detail::LightUnderSky::kBins, 0.0));
  std::vector<float> values;
  std::vector<double> to_sort;
  detail::CellHistogram histogram;
  double quantum = kNaN;
  for (std::size_t j = 0; j < rows_; ++j) {
    for (std::size_t i = 0; i < columns_; ++i) {
      const int x0 = cell_edge(i, columns_, area_.nx);
      const int x1 = cell_edge(i + 1, columns_, area_.nx);
      const int y0 = cell_edge(j, rows_, area_.ny);
      const int y1 = cell_edge(j + 1, rows_, area_.ny);
      const auto all = static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0);
      values.resize(all);
      std::size_t count = 0;
      for (int y = y0; y < y1; ++y) {
        const auto row = pixels.row(area_.y0 + y);
        const auto row_flags = flags.row(area_.y0 + y);
        for (auto x = static_cast<std::size_t>(x0); x < static_cast<std::size_t>(x1); ++x) {
          values[count] = row[x];
          count += usable(row[x], row_flags[x]) ? 1 : 0;
        }
      }
      values.resize(count);
      if (values.empty() || 2 * values.size() < all) continue;
      if (std::isnan(quantum)) quantum = detail::quantum_of(values);
      const bool mode = settings.estimator == SkyEstimator::kMode;
      SkyEstimate sky;
      std::vector<double>& block = cells.blocks[j / kBlock * cells.block_columns + i / kBlock];
      using Light = detail::LightUnderSky;
      if (histogram.fill(values, quantum) && histogram.clipped(settings.clip, mode, sky)) {
        if (fit_light) histogram.add_scaled(sky.level, sky.rms, Light::kReach, Light::kStep, block);
      } else {
        to_sort.assign(values.begin(), values.end());
        sky = clipped_sky(to_sort, settings.clip, mode);
        if (fit_light) detail::add_scaled(to_sort, sky.level, sky.rms, Light::kReach, Light::kStep, block);
      }
      cells.level[j * columns_ + i] = sky.level;
      cells.mode[j * columns_ + i] = sky.mode;
      cells.rms[j * columns_ + i] = sky.rms;
    }
  }
  for (std::vector<double>* cell : {&cells.level, &cells.mode, &cells.rms}) {
    fill_empty_cells(*cell);
    filter_cells(*cell, settings.filter);
  }
  // Of a median of n pixels, and of the median of filter² cells.
  const double width = static_cast<double>(area_.nx) / static_cast<double>(columns_);
  const double height = static_cast<double>(area_.ny) / static_cast<double>(rows_);
  const double filtered = settings.filter > 1 ? 0.5 * kPi / (settings.filter * settings.filter) : 1.0;
  // 2.5 median - 1.5 mean of normal values: 2.5² π/2 + 1.5² - 2·2.5·1.5.
  constexpr double kMode = 2.5 * 2.5 * 0.5 * kPi + 1.5 * 1.5 - 2.0 * 2.5 * 1.5;
  const double estimator = settings.estimator == SkyEstimator::kMode ? kMode : 0.5 * kPi;
  relative_error_ = std::sqrt(estimator * filtered / (width * height));
  lit_share_ = kNaN;
  // Where pixels are not distributed as the fit expects, the mode is the better guess.
  if (fit_light && !take_out_light(frame, cells)) {
    cells.level = cells.mode;
    relative_error_ = std::sqrt(kMode * filtered / (width * height));
  }
  median_level_ = median_of(cells.level);
  median_rms_ = median_of(cells.rms);
  level_ = make_grid(std::move(cells.level));
  rms_ = make_grid(std::move(cells.rms));
}

// Lowers the level of every cell by what a fit to the pixels of a block of cells finds of stars in it.
// @returns false without having done so.
bool BackgroundMap::take_out_light(const Frame& frame, Cells& cells) {
  const double rms = median_of(cells.rms);
  const double noise = frame.header.gain.value() * rms;  // e-
  const double readout = frame.header.readout_noise.value();
  if (!(rms > 0.0)) return false;
  // Where a pixel scatters by less than an electron, counts are not what the gain says they are.
  constexpr double kLeastNoise = 1.0;
  constexpr double kMostSkewness = 0.3;
  const bool photons = noise > kLeastNoise;
  const double skewness =
      photons ? std::min(kMostSkewness, std::max(0.0, noise * noise - readout * readout) / (noise * noise * noise))
              : 0.0;
  const detail::LightUnderSky model(skewness, photons ? 1.0 / noise : 0.0);
  constexpr double kFewest = 8192.0;  // pixels; with fewer the noise of the fit is larger than the light of a crowd
  std::vector<double> all(detail::LightUnderSky::kBins, 0.0);
  double total = 0.0;
  for (const auto& block : cells.blocks)
    for (std::size_t k = 0; k < block.size(); ++k) {
      all[k] += block[k];
      total += block[k];
    }
  if (total < kFewest) return false;
  const auto whole = model.fit(all);
  if (!whole.converged) return false;
  lit_share_ = whole.lit;
  std::vector<double> shift(cells.blocks.size(), whole.level);
  double error = whole.error;
  for (std::size_t b = 0; b < cells.blocks.size() && cells.blocks.size() > 1; ++b) {
    double count = 0.0;
    for (const double n : cells.blocks[b]) count += n;
    if (count < kFewest) continue;
    const auto fit = model.fit(cells.blocks[b]);
    if (!fit.converged) continue;
    shift[b] = fit.level;
    error = std::max(error, fit.error);
  }
  relative_error_ = std::sqrt(relative_error_ * relative_error_ + error * error);
  // Linear between the centres of blocks.
  const auto at = [](std::size_t cell, std::size_t blocks, std::size_t& first, std::size_t& second) {
    const double t = std::clamp((static_cast<double>(cell) + 0.5) / static_cast<double>(kBlock) - 0.5, 0.0,
                                static_cast<double>(blocks - 1));
    first = static_cast<std::size_t>(t);
    second = std::min(first + 1, blocks - 1);
    return t - static_cast<double>(first);
  };
  for (std::size_t j = 0; j < rows_; ++j) {
    for (std::size_t i = 0; i < columns_; ++i) {
      std::size_t x0 = 0;
      std::size_t x1 = 0;
      std::size_t y0 = 0;
      std::size_t y1 = 0;
      const double u = at(i, cells.block_columns, x0, x1);
      const double v = at(j, cells.block_rows, y0, y1);
      const double* low = shift.data() + y0 * cells.block_columns;
      const double* high = shift.data() + y1 * cells.block_columns;
      const double value = (1.0 - v) * ((1.0 - u) * low[x0] + u * low[x1]) + v * ((1.0 - u) * high[x0] + u * high[x1]);
      cells.level[j * columns_ + i] += value * cells.rms[j * columns_ + i];
    }
  }
  return true;
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
  if (columns_ == 1) {
    std::fill(out.begin(), out.end(), knots[0]);
    return;
  }
  // Cell by cell, so that the polynomial of each is looked up once.
  std::size_t x = 0;
  for (std::size_t i = 0; i + 1 < columns_; ++i) {
    const bool last = i + 2 == columns_;
    const double middle = (static_cast<double>(i) + 1.5) * cell_width - 0.5;
    const std::size_t end =
        last ? out.size() : std::min(out.size(), static_cast<std::size_t>(std::max(0.0, std::ceil(middle))));
    const double left = knots[i];
    const double right = knots[i + 1];
    const double bend_left = curvature[i] / 6.0;
    const double bend_right = curvature[i + 1] / 6.0;
    const double scale = 1.0 / cell_width;
    const double offset = 0.5 * scale - 0.5 - static_cast<double>(i);
    const auto first = static_cast<int>(x);
    const auto count = static_cast<int>(end) - first;
    double* row = out.data() + x;
    for (int k = 0; k < count; ++k) {
      const double b = static_cast<double>(first + k) * scale + offset;
      const double a = 1.0 - b;
      row[k] = a * left + b * right + ((a * a * a - a) * bend_left + (b * b * b - b) * bend_right);
    }
    x = std::max(x, end);
  }
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
                                     double outer, double clip) {
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
  const SkyEstimate sky = clipped_sky(values, clip, false);
  result.pixels = sky.pixels;
  if (sky.pixels < kFewestAnnulusPixels) return result;
  result.level = sky.level;
  result.rms = sky.rms;
  result.error = std::sqrt(0.5 * kPi / static_cast<double>(sky.pixels)) * sky.rms;
  return result;
}

}  // namespace astroid
