#include "flux_spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "astroid/core/statistics/sums.hpp"

namespace astroid::detail {

namespace {

constexpr std::size_t kFewestSamples = 4;  // per axis, for the spline to have an interior

void refuse_unusable(const PsfTable& table, double total) {
  std::vector<Problem> problems;
  const auto refuse = [&](const char* parameter, double value, const char* expected, const char* message) {
    problems.push_back(
        {.parameter = parameter, .value = fmt::format("{}", value), .expected = expected, .message = message});
  };
  const auto fewest = static_cast<int>(kFewestSamples);
  if (table.samples.nx() < fewest || table.samples.ny() < fewest) {
    refuse("PSF table", std::min(table.samples.nx(), table.samples.ny()), "at least 4 samples along each axis",
           "the table is too small");
  }
  if (!std::isfinite(total) || !(total > 0.0)) {
    refuse("PSF table", total, "finite samples with a positive sum", "the table cannot be normalised");
  }
  if (!(table.samples_per_pixel > 0.0) || !std::isfinite(table.samples_per_pixel)) {
    refuse("samples per pixel", table.samples_per_pixel, "a positive number", "the table has no scale");
  }
  const bool inside = table.centre_x >= -0.5 && table.centre_x <= table.samples.nx() - 0.5 && table.centre_y >= -0.5 &&
                      table.centre_y <= table.samples.ny() - 0.5;
  if (!inside) {
    problems.push_back({.parameter = "PSF origin",
                        .value = fmt::format("({}, {})", table.centre_x, table.centre_y),
                        .expected = "a place within the table, in 0-based samples",
                        .message = "the origin is outside the table"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

// Many splines in memory: the values of a knot side by side, knots `stride` apart.
struct Splines {
  double* first;
  std::size_t knots, stride, lanes;
};

// Coefficients c[-1 … n+1] of natural cubic B-splines through the values at the knots 0 … n, in place: the values stand
// at 1 … n+1 of n + 3 knots. Natural: c[-1] - 2 c[0] + c[1] = 0, so c[0] is the value itself.
void interpolate(const Splines& splines) {
  const std::size_t lanes = splines.lanes;
  const std::size_t last = splines.knots - 2;  // where the last value stands
  const auto knot = [&](std::size_t k) { return splines.first + k * splines.stride; };
  // Thomas' algorithm for c[k-1] + 4 c[k] + c[k+1] = 6 y[k] between the known ends.
  std::vector<double> pivots(splines.knots, 0.0);
  for (std::size_t k = 2; k < last; ++k) {
    const double pivot = 1.0 / (4.0 - pivots[k - 1]);
    pivots[k] = pivot;
    const double* before = knot(k - 1);
    double* here = knot(k);
    for (std::size_t i = 0; i < lanes; ++i) here[i] = (6.0 * here[i] - before[i]) * pivot;
  }
  for (std::size_t k = last - 1; k > 1; --k) {
    const double* after = knot(k + 1);
    double* here = knot(k);
    for (std::size_t i = 0; i < lanes; ++i) here[i] -= pivots[k] * after[i];
  }
  for (std::size_t i = 0; i < lanes; ++i) {
    knot(0)[i] = 2.0 * knot(1)[i] - knot(2)[i];
    knot(last + 1)[i] = 2.0 * knot(last)[i] - knot(last - 1)[i];
  }
}

}  // namespace

FluxSpline::FluxSpline(const PsfTable& table)
    : nx_(static_cast<std::size_t>(table.samples.nx())),
      ny_(static_cast<std::size_t>(table.samples.ny())),
      samples_per_pixel_(table.samples_per_pixel),
      centre_x_(table.centre_x + 0.5),
      centre_y_(table.centre_y + 0.5) {
  const double total = pairwise_sum(table.samples.pixels());
  refuse_unusable(table, total);
  const std::size_t stride = nx_ + 3;
  coefficients_.assign(stride * (ny_ + 3), 0.0);
  // Running integral at the corners of the samples; corner (i, j) stands at (i + 1, j + 1).
  const std::span<const double> samples = table.samples.pixels();
  std::vector<CompensatedSum> columns(nx_);
  for (std::size_t j = 0; j < ny_; ++j) {
    CompensatedSum row;
    double* corners = &coefficients_[(j + 2) * stride + 2];
    for (std::size_t i = 0; i < nx_; ++i) {
      columns[i].add(samples[j * nx_ + i] / total);
      row.add(columns[i].value());
      corners[i] = row.value();
    }
  }
  for (std::size_t j = 1; j < ny_ + 2; ++j) interpolate({&coefficients_[j * stride], stride, 1, 1});
  interpolate({coefficients_.data(), ny_ + 3, stride, stride});
}

FluxSpline::Edge FluxSpline::edge(double offset, double centre, std::size_t samples) const {
  const auto end = static_cast<double>(samples);
  const double u = std::clamp(centre + offset * samples_per_pixel_, 0.0, end);
  const double interval = std::min(std::floor(u), end - 1.0);
  const double t = u - interval;
  const double s = 1.0 - t;
  constexpr double kSixth = 1.0 / 6.0;
  return {static_cast<std::size_t>(interval),
          {kSixth * s * s * s, kSixth * (4.0 - 3.0 * t * t * (1.0 + s)), kSixth * (4.0 - 3.0 * s * s * (1.0 + t)),
           kSixth * t * t * t}};
}

void FluxSpline::at_edges(std::span<const Edge> edges, std::span<double> rows) const {
  const std::size_t stride = nx_ + 3;
  ASTROID_CHECK_EQ(rows.size(), coefficient_rows() * edges.size());
  double* out = rows.data();
  for (std::size_t j = 0; j < ny_ + 3; ++j) {
    const double* row = &coefficients_[j * stride];
    for (const Edge& edge : edges) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += edge.weights[k] * row[edge.first + k];
      *out++ = sum;
    }
  }
}

void FluxSpline::integrate_rows(const Edge& left, const Edge& right, std::span<double> rows) const {
  const std::size_t stride = nx_ + 3;
  for (std::size_t j = 0; j < ny_ + 3; ++j) {
    const double* row = &coefficients_[j * stride];
    double below = 0.0;
    double above = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      below += left.weights[k] * row[left.first + k];
      above += right.weights[k] * row[right.first + k];
    }
    rows[j] = above - below;
  }
}

double FluxSpline::integrate_column(std::span<const double> rows, const Edge& bottom, const Edge& top) {
  double below = 0.0;
  double above = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    below += bottom.weights[k] * rows[bottom.first + k];
    above += top.weights[k] * rows[top.first + k];
  }
  return above - below;
}

double FluxSpline::flux(PixelPosition lower, PixelPosition upper) const {
  const Edge left = x_edge(lower.x);
  const Edge right = x_edge(upper.x);
  const std::size_t stride = nx_ + 3;
  const auto strip = [&](const Edge& edge) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double* row = &coefficients_[(edge.first + k) * stride];
      double below = 0.0;
      double above = 0.0;
      for (std::size_t l = 0; l < 4; ++l) {
        below += left.weights[l] * row[left.first + l];
        above += right.weights[l] * row[right.first + l];
      }
      sum += edge.weights[k] * (above - below);
    }
    return sum;
  };
  return strip(y_edge(upper.y)) - strip(y_edge(lower.y));
}

double FluxSpline::density(PixelPosition offset) const {
  const double u = centre_x_ + offset.x * samples_per_pixel_;
  const double v = centre_y_ + offset.y * samples_per_pixel_;
  const auto end_x = static_cast<double>(nx_);
  const auto end_y = static_cast<double>(ny_);
  if (!(u >= 0.0 && u < end_x && v >= 0.0 && v < end_y)) return 0.0;
  // Derivatives of the weights of edge().
  const auto slopes = [](double t) {
    const double s = 1.0 - t;
    return std::array<double, 4>{-0.5 * s * s, 0.5 * t * (3.0 * t - 4.0), 0.5 * s * (4.0 - 3.0 * s), 0.5 * t * t};
  };
  const double column = std::floor(u);
  const double row = std::floor(v);
  const std::array<double, 4> along_x = slopes(u - column);
  const std::array<double, 4> along_y = slopes(v - row);
  const double* from = &coefficients_[static_cast<std::size_t>(row) * (nx_ + 3) + static_cast<std::size_t>(column)];
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k, from += nx_ + 3)
    sum += along_y[k] * (along_x[0] * from[0] + along_x[1] * from[1] + along_x[2] * from[2] + along_x[3] * from[3]);
  return sum * samples_per_pixel_ * samples_per_pixel_;
}

PixelPosition FluxSpline::lower() const {
  return {-centre_x_ / samples_per_pixel_, -centre_y_ / samples_per_pixel_};
}

PixelPosition FluxSpline::upper() const {
  return {(static_cast<double>(nx_) - centre_x_) / samples_per_pixel_,
          (static_cast<double>(ny_) - centre_y_) / samples_per_pixel_};
}

}  // namespace astroid::detail
