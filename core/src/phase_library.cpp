#include "phase_library.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vector/stamp_kernels.hpp"

namespace astroid::detail {

namespace {
constexpr int kBorder = 1;  // a tap lies in the pixel of the star or in one next to it
}  // namespace

PhaseLibrary::Extent PhaseLibrary::extent(double lower, double upper) {
  // A pixel n of a star at phase f in [0, 1) covers n - f - 1/2 … n - f + 1/2.
  const int first = static_cast<int>(std::floor(lower - 0.5)) - kBorder;
  const int last = static_cast<int>(std::ceil(upper + 1.5)) + kBorder;
  return {first, last - first + 1};
}

double PhaseLibrary::bytes(const FluxSpline& spline, int phases) {
  const Extent x = extent(spline.lower().x, spline.upper().x);
  const Extent y = extent(spline.lower().y, spline.upper().y);
  return static_cast<double>(sizeof(double)) * phases * phases * x.size * y.size;
}

PhaseLibrary::PhaseLibrary(const FluxSpline& spline, int phases, PixelResponse response)
    : phases_(phases),
      response_(std::move(response)),
      x_(extent(spline.lower().x, spline.upper().x)),
      y_(extent(spline.lower().y, spline.upper().y)) {
  std::vector<double> shifts(static_cast<std::size_t>(phases));
  for (std::size_t p = 0; p < shifts.size(); ++p) shifts[p] = static_cast<double>(p) * (1.0 / phases);
  images_ = exact_images(spline, shifts);
}

std::vector<double> PhaseLibrary::exact_images(const FluxSpline& spline, std::span<const double> shifts) const {
  const auto nx = static_cast<std::size_t>(x_.size);
  const auto ny = static_cast<std::size_t>(y_.size);
  const std::size_t n = shifts.size();
  const auto cells = static_cast<std::size_t>(response_.cells);
  std::vector<double> images(n * n * nx * ny);
  const double cell = 1.0 / response_.cells;
  // Edge `i` of the cells, cells of them to a pixel.
  const auto edge_at = [&](const Extent& e, std::size_t i, double shift) {
    return e.first + static_cast<double>(i) * cell - 0.5 - shift;
  };
  const std::size_t x_count = nx * cells + 1;
  const std::size_t y_count = ny * cells + 1;
  std::vector<FluxSpline::Edge> y_edges(n * y_count);
  for (std::size_t q = 0; q < n; ++q) {
    for (std::size_t j = 0; j < y_count; ++j) y_edges[q * y_count + j] = spline.y_edge(edge_at(y_, j, shifts[q]));
  }
  // Shifts along x in groups, whose edges share the cache lines of the coefficients.
  constexpr std::size_t kMostInGroup = 8;
  constexpr std::size_t kGroupBytes = 4UL * 1024UL * 1024UL;
  const std::size_t group =
      std::clamp<std::size_t>(kGroupBytes / (spline.coefficient_rows() * x_count * sizeof(double)), 1, kMostInGroup);
  std::vector<FluxSpline::Edge> edges;
  std::vector<double> rows;
  std::vector<double> below;
  std::vector<double> above;
  for (std::size_t p0 = 0; p0 < n; p0 += group) {
    const std::size_t p1 = std::min(p0 + group, n);
    edges.clear();
    for (std::size_t p = p0; p < p1; ++p)
      for (std::size_t i = 0; i < x_count; ++i) edges.push_back(spline.x_edge(edge_at(x_, i, shifts[p])));
    rows.resize(spline.coefficient_rows() * edges.size());
    spline.at_edges(edges, rows);
    below.resize(edges.size());
    above.resize(edges.size());
    // C along the line of an edge in y, at all edges in x.
    const auto combine = [&](const FluxSpline::Edge& edge, std::vector<double>& line) {
      const double* from = &rows[edge.first * edges.size()];
      const std::size_t count = edges.size();
      for (std::size_t e = 0; e < count; ++e)
        line[e] = edge.weights[0] * from[e] + edge.weights[1] * from[e + count] +
                  edge.weights[2] * from[e + 2 * count] + edge.weights[3] * from[e + 3 * count];
    };
    for (std::size_t q = 0; q < n; ++q) {
      combine(y_edges[q * y_count], below);
      for (std::size_t j = 0; j < ny * cells; ++j) {
        combine(y_edges[q * y_count + j + 1], above);
        for (std::size_t e = 0; e < edges.size(); ++e) below[e] = above[e] - below[e];
        for (std::size_t p = p0; p < p1; ++p) {
          const double* strip = &below[(p - p0) * x_count];
          double* row = &images[((q * n + p) * ny + j / cells) * nx];
          for (std::size_t i = 0; i < nx * cells; ++i)
            row[i / cells] +=
                response_.at(static_cast<int>(i % cells), static_cast<int>(j % cells)) * (strip[i + 1] - strip[i]);
        }
        std::swap(below, above);
      }
    }
  }
  return images;
}

const double* PhaseLibrary::image(int phase_x, int phase_y) const {
  const auto index =
      static_cast<std::size_t>(phase_y) * static_cast<std::size_t>(phases_) + static_cast<std::size_t>(phase_x);
  return images_.data() + index * static_cast<std::size_t>(x_.size) * static_cast<std::size_t>(y_.size);
}

PhaseLibrary::Axis PhaseLibrary::axis(double position) const {
  const double pixel = std::floor(position);
  const double s = (position - pixel) * phases_;
  const double node = std::floor(s);
  const double t = s - node;
  Axis axis{.pixel = static_cast<int>(pixel)};
  constexpr double kHalf = 0.5;
  constexpr double kSixth = 1.0 / 6.0;
  const double a = t + 1.0;
  const double b = t - 1.0;
  const double c = t - 2.0;
  const std::array<double, kTaps> weights = {-kSixth * t * b * c, kHalf * a * b * c, -kHalf * a * t * c,
                                             kSixth * a * t * b};
  const std::array<double, kTaps> slopes = {-kSixth * (b * c + t * c + t * b), kHalf * (b * c + a * c + a * b),
                                            -kHalf * (t * c + a * c + a * t), kSixth * (t * b + a * b + a * t)};
  for (std::size_t k = 0; k < kTaps; ++k) {
    // Nodes node - 1 … node + 2; one outside 0 … phases - 1 is a phase of a neighbouring pixel.
    const int phase = static_cast<int>(node) - 1 + static_cast<int>(k);
    const int shift = phase < 0 ? -1 : phase / phases_;
    axis.taps[k] = {phase - shift * phases_, shift, weights[k], slopes[k] * phases_};
  }
  return axis;
}

template <class F>
void PhaseLibrary::for_each_run(const Axis& x, const Axis& y, Rectangle box, F&& f) const {
  for (const Tap& tap_y : y.taps) {
    // Detector row of the library's first row for this node.
    const int row_origin = y.pixel + tap_y.shift + y_.first;
    const int row_begin = std::max(box.y0, row_origin);
    const int row_end = std::min(box.y1(), row_origin + y_.size);
    for (const Tap& tap_x : x.taps) {
      const int column_origin = x.pixel + tap_x.shift + x_.first;
      const int column_begin = std::max(box.x0, column_origin);
      const int count = std::min(box.x1(), column_origin + x_.size) - column_begin;
      if (count <= 0) continue;
      const double* from = image(tap_x.phase, tap_y.phase) + (column_begin - column_origin);
      for (int row = row_begin; row < row_end; ++row) {
        const auto out = static_cast<std::size_t>(row - box.y0) * static_cast<std::size_t>(box.nx) +
                         static_cast<std::size_t>(column_begin - box.x0);
        f(from + static_cast<std::size_t>(row - row_origin) * static_cast<std::size_t>(x_.size), out,
          static_cast<std::size_t>(count), tap_x, tap_y);
      }
    }
  }
}

void PhaseLibrary::integrate(PixelPosition star, Rectangle box, std::span<double> fractions) const {
  std::ranges::fill(fractions, 0.0);
  for_each_run(axis(star.x), axis(star.y), box,
               [&](const double* from, std::size_t out, std::size_t count, const Tap& x, const Tap& y) {
                 const double weight = x.weight * y.weight;
                 double* to = fractions.data() + out;
                 for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
               });
  // Where light ends, interpolation overshoots by what it errs.
  for (double& fraction : fractions) fraction = std::max(fraction, 0.0);
}

void PhaseLibrary::add(PixelPosition star, double electrons, Rectangle box,
                       const ImageView<double, unit::ExpectedElectrons>& image) const {
  const Axis x = axis(star.x);
  const Axis y = axis(star.y);
  // Inside the border every tap has the pixel.
  const Rectangle stamp = intersect(
      box, {x.pixel + x_.first + kBorder, y.pixel + y_.first + kBorder, x_.size - 2 * kBorder, y_.size - 2 * kBorder});
  if (stamp.empty()) return;
  PrfStamp prf{.images = {}, .weights = {}, .image_stride = static_cast<std::size_t>(x_.size), .electrons = electrons};
  std::size_t k = 0;
  for (const Tap& tap_y : y.taps)
    for (const Tap& tap_x : x.taps) {
      const int column = stamp.x0 - (x.pixel + tap_x.shift + x_.first);
      const int row = stamp.y0 - (y.pixel + tap_y.shift + y_.first);
      prf.images[k] = this->image(tap_x.phase, tap_y.phase) + static_cast<std::ptrdiff_t>(row) * x_.size + column;
      prf.weights[k++] = tap_x.weight * tap_y.weight;
    }
  add_prf_stamp(prf, stamp_pixels(image, stamp));
}

void PhaseLibrary::integrate_gradient(PixelPosition star, Rectangle box, std::span<double> dpdx,
                                      std::span<double> dpdy) const {
  std::ranges::fill(dpdx, 0.0);
  std::ranges::fill(dpdy, 0.0);
  for_each_run(axis(star.x), axis(star.y), box,
               [&](const double* from, std::size_t out, std::size_t count, const Tap& x, const Tap& y) {
                 const double along_x = x.slope * y.weight;
                 const double along_y = x.weight * y.slope;
                 for (std::size_t i = 0; i < count; ++i) {
                   dpdx[out + i] += along_x * from[i];
                   dpdy[out + i] += along_y * from[i];
                 }
               });
}

Rectangle PhaseLibrary::interior() const {
  constexpr int kSteps = 4;   // px: the border, and as far as the light of the taps reaches across it
  constexpr int kFewest = 4;  // px that are judged of a small table too: the star's, wherever it is in it
  const auto steps = [&](int size) { return std::clamp((size - kFewest) / 2, 0, kSteps); };
  const int x = steps(x_.size);
  const int y = steps(y_.size);
  return {x_.first + x, y_.first + y, x_.size - 2 * x, y_.size - 2 * y};
}

double PhaseLibrary::measured_error(const FluxSpline& spline, const Judged& judged) const {
  constexpr int kMostPositions = 16;  // per axis, spread over the pixel
  constexpr int kFewerPositions = 8;  // of large images
  constexpr int kLarge = 4096;        // px
  constexpr int kSmallestSquare = 2;
  constexpr int kLargestSquare = 3;
  const int positions = std::min(phases_, x_.size * y_.size > kLarge ? kFewerPositions : kMostPositions);
  std::vector<double> shifts(static_cast<std::size_t>(positions));
  for (int k = 0; k < positions; ++k) {
    const int phase = k * phases_ / positions;
    shifts[static_cast<std::size_t>(k)] = (phase + 0.5) / phases_;
  }
  const std::vector<double> exact = exact_images(spline, shifts);
  const Rectangle box{x_.first, y_.first, x_.size, y_.size};
  const Rectangle outer = intersect(box, judged.outer);
  std::vector<double> fractions(box.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < shifts.size() * shifts.size(); ++k) {
    const double* truth = &exact[k * box.size()];
    integrate({shifts[k % shifts.size()], shifts[k / shifts.size()]}, box, fractions);
    const auto judge = [&](const Rectangle& square) {
      double light = 0.0;
      double error = 0.0;
      for (int y = square.y0; y < square.y1(); ++y)
        for (int x = square.x0; x < square.x1(); ++x) {
          const auto i = static_cast<std::size_t>((y - box.y0) * box.nx + x - box.x0);
          light += truth[i];
          error += fractions[i] - truth[i];
        }
      worst = std::max(worst, std::abs(error) / std::max(std::abs(light), judged.least));
    };
    for (int size = kSmallestSquare; size <= kLargestSquare; ++size)
      for (int y = outer.y0; y + size <= outer.y1(); ++y)
        for (int x = outer.x0; x + size <= outer.x1(); ++x) {
          const Rectangle square{x, y, size, size};
          if (intersect(square, judged.hole).empty()) judge(square);
        }
  }
  return worst;
}

}  // namespace astroid::detail
