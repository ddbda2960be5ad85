#include "field_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

// Of a squared distance: r² log r² for the thin-plate spline, -r otherwise.
double kernel(bool thin_plate, double square) {
  if (square == 0.0) return 0.0;
  return thin_plate ? square * det::log(square) : -det::sqrt(square);
}

// Its derivative with respect to the squared distance.
double kernel_slope(bool thin_plate, double square) {
  if (square == 0.0) return 0.0;
  return thin_plate ? det::log(square) + 1.0 : -0.5 / det::sqrt(square);
}

}  // namespace

FieldWeights::FieldWeights(std::vector<PixelPosition> nodes) : nodes_(std::move(nodes)) {
  lower_ = upper_ = nodes_.front();
  for (const PixelPosition& p : nodes_) {
    lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y)};
    upper_ = {std::max(upper_.x, p.x), std::max(upper_.y, p.y)};
  }
  const double size = std::max(upper_.x - lower_.x, upper_.y - lower_.y);
  scale_ = size > 0.0 ? 1.0 / size : 1.0;
  constexpr std::size_t kOfAPlane = 3;
  thin_plate_ = nodes_.size() >= kOfAPlane && solve(true);
  if (!thin_plate_) solve(false);
}

bool FieldWeights::solve(bool thin_plate) {
  const std::size_t n = nodes_.size();
  const std::size_t terms = thin_plate ? 3 : 1;
  const std::size_t m = n + terms;
  const std::size_t width = m + n;
  std::vector<double> a(m * width, 0.0);  // the symmetric matrix, and unit columns for the nodes
  for (std::size_t i = 0; i < n; ++i) {
    const double x = scale_ * (nodes_[i].x - lower_.x);
    const double y = scale_ * (nodes_[i].y - lower_.y);
    for (std::size_t j = 0; j < n; ++j) {
      const double dx = scale_ * (nodes_[i].x - nodes_[j].x);
      const double dy = scale_ * (nodes_[i].y - nodes_[j].y);
      a[i * width + j] = kernel(thin_plate, dx * dx + dy * dy);
    }
    const double linear[] = {1.0, x, y};
    for (std::size_t t = 0; t < terms; ++t) a[i * width + n + t] = a[(n + t) * width + i] = linear[t];
    a[i * width + m + i] = 1.0;
  }
  // Gauss and Jordan with partial pivoting.
  constexpr double kSingular = 1e-9;
  for (std::size_t c = 0; c < m; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < m; ++r)
      if (std::abs(a[r * width + c]) > std::abs(a[pivot * width + c])) pivot = r;
    if (!(std::abs(a[pivot * width + c]) > kSingular)) return false;
    if (pivot != c) std::swap_ranges(&a[c * width], &a[c * width] + width, &a[pivot * width]);
    const double factor = 1.0 / a[c * width + c];
    for (std::size_t k = 0; k < width; ++k) a[c * width + k] *= factor;
    for (std::size_t r = 0; r < m; ++r) {
      const double part = a[r * width + c];
      if (r == c || part == 0.0) continue;
      for (std::size_t k = 0; k < width; ++k) a[r * width + k] -= part * a[c * width + k];
    }
  }
  rows_ = m;
  inverse_.resize(m * n);
  for (std::size_t r = 0; r < m; ++r)
    for (std::size_t i = 0; i < n; ++i) inverse_[r * n + i] = a[r * width + m + i];
  return true;
}

PixelPosition FieldWeights::inside(PixelPosition position) const {
  return {std::clamp(position.x, lower_.x, upper_.x), std::clamp(position.y, lower_.y, upper_.y)};
}

void FieldWeights::at(PixelPosition position, std::span<double> weights) const {
  const PixelPosition p = inside(position);
  const std::size_t n = nodes_.size();
  std::fill(weights.begin(), weights.end(), 0.0);
  const auto add = [&](std::size_t row, double basis) {
    for (std::size_t i = 0; i < n; ++i) weights[i] += basis * inverse_[row * n + i];
  };
  for (std::size_t j = 0; j < n; ++j) {
    const double dx = scale_ * (p.x - nodes_[j].x);
    const double dy = scale_ * (p.y - nodes_[j].y);
    add(j, kernel(thin_plate_, dx * dx + dy * dy));
  }
  add(n, 1.0);
  if (!thin_plate_) return;
  add(n + 1, scale_ * (p.x - lower_.x));
  add(n + 2, scale_ * (p.y - lower_.y));
}

void FieldWeights::gradient(PixelPosition position, std::span<double> along_x, std::span<double> along_y) const {
  const PixelPosition p = inside(position);
  const std::size_t n = nodes_.size();
  std::fill(along_x.begin(), along_x.end(), 0.0);
  std::fill(along_y.begin(), along_y.end(), 0.0);
  const auto add = [&](std::span<double> sum, std::size_t row, double slope) {
    for (std::size_t i = 0; i < n; ++i) sum[i] += scale_ * slope * inverse_[row * n + i];
  };
  for (std::size_t j = 0; j < n; ++j) {
    const double dx = scale_ * (p.x - nodes_[j].x);
    const double dy = scale_ * (p.y - nodes_[j].y);
    const double slope = 2.0 * kernel_slope(thin_plate_, dx * dx + dy * dy);
    add(along_x, j, slope * dx);
    add(along_y, j, slope * dy);
  }
  if (thin_plate_) {
    add(along_x, n + 1, 1.0);
    add(along_y, n + 2, 1.0);
  }
  if (p.x != position.x) std::fill(along_x.begin(), along_x.end(), 0.0);
  if (p.y != position.y) std::fill(along_y.begin(), along_y.end(), 0.0);
}

void require_field(std::span<const FieldPsfTable> tables) {
  std::vector<Problem> problems;
  const auto refuse = [&problems](const std::string& value, const char* expected, const char* message) {
    problems.push_back({.parameter = "PSF/File", .value = value, .expected = expected, .message = message});
  };
  if (tables.empty()) refuse("no table", "at least one table with its place in the field", "the PSF cannot be made");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const PixelPosition& p = tables[i].position;
    const std::string place = fmt::format("({}, {})", p.x, p.y);
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) refuse(place, "two pixel coordinates", "a table has no place");
    for (std::size_t j = 0; j < i; ++j)
      if (tables[j].position.x == p.x && tables[j].position.y == p.y)
        refuse(place, "one table a place", "two tables have the same place");
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace astroid::detail
