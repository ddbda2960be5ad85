#include "astroid/sim/brighter_fatter.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

/// Exponential integral E1(x) = integral of exp(-t)/t from x on, x > 0. Power series or continued fraction.
/// @accuracy relative 1e-13. @source AbramowitzStegun1964, 5.1.11 and 5.1.22.
double exponential_integral(double x) {
  constexpr int kTerms = 100;
  if (x < 2.0) {
    double term = 1.0;
    double sum = -std::numbers::egamma - det::log(x);
    for (int k = 1; k < kTerms; ++k) {
      term *= -x / k;
      sum -= term / k;
    }
    return sum;
  }
  double fraction = 0.0;
  for (int k = kTerms; k > 0; --k) fraction = k / (1.0 + k / (x + fraction));
  return det::exp(-x) / (x + fraction);
}

/// Rows of an image as they were, with zeros around them: the last few at hand while the image changes.
class Originals {
 public:
  Originals(const ImageView<double, unit::SampledElectrons>& image, int range)
      : image_(image),
        range_(range),
        stride_(static_cast<std::size_t>(image.nx() + 2 * range)),
        rows_(stride_ * static_cast<std::size_t>(2 * range)) {}
  /// Keeps row y, which nothing has changed yet; beyond the image, zeros.
  void keep(int y) {
    const std::span<double> row = std::span(rows_).subspan(begin(y), stride_);
    if (y >= image_.area().y1())
      std::ranges::fill(row, 0.0);
    else
      std::ranges::copy(image_.row(y), row.begin() + range_);
  }
  /// The first pixel of row y; `range` zeros are before it and behind the last.
  [[nodiscard]] const double* row(int y) const { return rows_.data() + begin(y) + range_; }

 private:
  [[nodiscard]] std::size_t begin(int y) const {
    const int rows = 2 * range_;
    const int from_first = y - image_.area().y0 + rows;  // rows before the first are zeros
    return static_cast<std::size_t>(from_first % rows) * stride_;
  }
  const ImageView<double, unit::SampledElectrons>& image_;
  int range_;
  std::size_t stride_;
  std::vector<double> rows_;
};

/// Charge that crosses boundaries side by side, and what is at work for that.
class Crossings {
 public:
  Crossings(int nx, const BoundaryShifts& shifts)
      : nx_(nx),
        shifts_(shifts),
        sums_(static_cast<std::size_t>(nx + 2 * shifts.range())),
        moved_(static_cast<std::size_t>(nx)) {}

  /// From the pixels of row y to the next in x. @returns boundaries cut
  std::int64_t between_columns(const Originals& original, int y) {
    std::ranges::fill(moved_, 0.0);
    const int range = shifts_.range();
    double* const sum = sums_.data() + range;
    for (int j = 0; j < range; ++j) {
      const double* const above = original.row(y + j);
      const double* const below = original.row(y - j);
      for (int x = -range; x < nx_ + range; ++x) sum[x] = j == 0 ? above[x] : above[x] + below[x];
      for (int d = 0; d < range; ++d) {
        const double a = shifts_.serial(d, j);
        double* const shift = moved_.data();
        for (int x = 0; x < nx_ - 1; ++x) shift[x] += a * (sum[x - d] - sum[x + 1 + d]);
      }
    }
    const double* const row = original.row(y);
    return cut(row, row + 1, nx_ - 1);
  }

  /// From the pixels of row y to those of row y + 1. @returns boundaries cut
  std::int64_t between_rows(const Originals& original, int y) {
    std::ranges::fill(moved_, 0.0);
    const int range = shifts_.range();
    double* const difference = sums_.data() + range;
    for (int d = 0; d < range; ++d) {
      const double* const below = original.row(y - d);
      const double* const above = original.row(y + 1 + d);
      for (int x = -range; x < nx_ + range; ++x) difference[x] = below[x] - above[x];
      double* const shift = moved_.data();
      const double nearest = shifts_.parallel(d, 0);
      for (int x = 0; x < nx_; ++x) shift[x] += nearest * difference[x];
      for (int j = 1; j < range; ++j) {
        const double a = shifts_.parallel(d, j);
        for (int x = 0; x < nx_; ++x) shift[x] += a * (difference[x - j] + difference[x + j]);
      }
    }
    return cut(original.row(y), original.row(y + 1), nx_);
  }

  /// e- that go from each pixel to the next.
  [[nodiscard]] std::span<const double> moved() const { return moved_; }

 private:
  /// Turns shifts into charge; a pixel gives at most a quarter across each of its four boundaries.
  std::int64_t cut(const double* from, const double* to, int boundaries) {
    constexpr double kQuarter = 0.25;
    std::int64_t number = 0;
    double* const moved = moved_.data();
    for (int x = 0; x < boundaries; ++x) {
      const double wanted = kQuarter * moved[x] * (from[x] + to[x]);
      const double most = kQuarter * from[x];
      const double least = -kQuarter * to[x];
      const double allowed = wanted < most ? wanted : most;
      moved[x] = allowed > least ? allowed : least;
      number += moved[x] != wanted ? 1 : 0;
    }
    return number;
  }

  int nx_;
  const BoundaryShifts& shifts_;
  std::vector<double> sums_;
  std::vector<double> moved_;
};

}  // namespace

BoundaryShifts::BoundaryShifts(const BrighterFatterSettings& settings) : range_(settings.range) {
  constexpr int kLongest = 16;
  constexpr double kHalf = 0.5;
  ASTROID_CHECK_LE(1, range_);
  ASTROID_CHECK_LE(range_, kLongest);
  const double nearest = exponential_integral(settings.decay * kHalf);
  for (int d = 0; d < range_; ++d) {
    for (int j = 0; j < range_; ++j) {
      const double along = d + kHalf;
      const double distance = det::hypot(along, j);
      const double share = exponential_integral(settings.decay * distance) / nearest * along / distance;
      serial_.push_back(settings.serial * share);
      parallel_.push_back(settings.parallel * share);
    }
  }
}

std::int64_t brighter_fatter(const ImageView<double, unit::SampledElectrons>& electrons, const BoundaryShifts& shifts) {
  const Rectangle& area = electrons.area();
  if (area.empty()) return 0;
  const int range = shifts.range();
  Originals original(electrons, range);
  Crossings crossings(area.nx, shifts);
  std::int64_t number = 0;
  for (int y = area.y0; y < area.y0 + range; ++y) original.keep(y);
  for (int y = area.y0; y < area.y1(); ++y) {
    original.keep(y + range);
    const std::span<double> row = electrons.row(y);
    number += crossings.between_columns(original, y);
    const std::span<const double> moved = crossings.moved();
    for (std::size_t x = 0; x + 1 < row.size(); ++x) {
      row[x] -= moved[x];
      row[x + 1] += moved[x];
    }
    if (y + 1 == area.y1()) break;
    number += crossings.between_rows(original, y);
    const std::span<double> next = electrons.row(y + 1);
    for (std::size_t x = 0; x < row.size(); ++x) {
      row[x] -= moved[x];
      next[x] += moved[x];
    }
  }
  return number;
}

}  // namespace astroid
