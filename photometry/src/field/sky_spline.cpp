#include "field/sky_spline.hpp"

#include <algorithm>
#include <cmath>

namespace astroid::detail {

namespace {

// The four uniform cubic B-splines at offset t in [0, 1] from the knot.
std::array<double, 4> cubic_splines(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0, (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
          t * t * t / 6.0};
}

}  // namespace

SplineAxis::SplineAxis(int pixels, int cell)
    : pixels_(pixels),
      cells_(std::max(1.0, std::round(static_cast<double>(pixels) / cell))),
      coefficients_(static_cast<std::size_t>(cells_) + 3) {
  const int blocks = (pixels + kBlock - 1) / kBlock;
  for (int i = 0; i < blocks; ++i) {
    const int last = std::min(pixels, (i + 1) * kBlock) - 1;
    at_block_.push_back(at(0.5 * (i * kBlock + last)));
  }
  for (int x = 0; x < pixels; ++x) at_pixel_.push_back(at(x));
  std::vector<std::array<double, 4>> gram(coefficients_);  // (i, i-3) … (i, i)
  for (const SplineWeights& w : at_block_)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b <= a; ++b) gram[w.first + a][3 - (a - b)] += w.weight[a] * w.weight[b];
  // In images of a few pixels there are more splines than blocks; a small diagonal keeps the rest at zero.
  constexpr double kRidge = 1e-6;
  double largest = 0.0;
  for (const auto& row : gram) largest = std::max(largest, row[3]);
  for (auto& row : gram) row[3] += kRidge * largest;
  cholesky_ = gram;
  for (std::size_t i = 0; i < coefficients_; ++i) {
    for (std::size_t j = i >= 3 ? i - 3 : 0; j <= i; ++j) {
      double sum = gram[i][3 - (i - j)];
      for (std::size_t k = i >= 3 ? i - 3 : 0; k < j; ++k)
        if (j - k <= 3) sum -= cholesky_[i][3 - (i - k)] * cholesky_[j][3 - (j - k)];
      cholesky_[i][3 - (i - j)] = i == j ? std::sqrt(sum) : sum / cholesky_[j][3];
    }
  }
}

SplineWeights SplineAxis::at(double position) const {
  // Cells are stretched to fill the axis; beyond its ends the first and last piece go on.
  const double t = (position + 0.5) * cells_ / pixels_;
  const double cell = std::clamp(std::floor(t), 0.0, cells_ - 1.0);
  return {cubic_splines(t - cell), static_cast<std::size_t>(cell)};
}

void SplineAxis::solve_gram(double* v, std::size_t stride) const {
  for (std::size_t i = 0; i < coefficients_; ++i) {
    double sum = v[i * stride];
    for (std::size_t k = i >= 3 ? i - 3 : 0; k < i; ++k) sum -= cholesky_[i][3 - (i - k)] * v[k * stride];
    v[i * stride] = sum / cholesky_[i][3];
  }
  for (std::size_t i = coefficients_; i-- > 0;) {
    double sum = v[i * stride];
    for (std::size_t k = i + 1; k < std::min(coefficients_, i + 4); ++k)
      sum -= cholesky_[k][3 - (k - i)] * v[k * stride];
    v[i * stride] = sum / cholesky_[i][3];
  }
}

void SkySpline::evaluate_blocks(std::span<const double> coefficients, std::span<double> values) const {
  const std::size_t columns = x_.size();
  scratch_.assign(columns, 0.0);
  for (std::size_t j = 0; j < y_.blocks(); ++j) {
    const SplineWeights& wy = y_.at_block(j);
    for (std::size_t i = 0; i < columns; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += wy.weight[k] * coefficients[(wy.first + k) * columns + i];
      scratch_[i] = sum;
    }
    for (std::size_t i = 0; i < x_.blocks(); ++i) {
      const SplineWeights& wx = x_.at_block(i);
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += wx.weight[k] * scratch_[wx.first + k];
      values[j * x_.blocks() + i] = sum;
    }
  }
}

void SkySpline::collect_blocks(std::span<const double> values, std::span<double> coefficients) const {
  const std::size_t columns = x_.size();
  for (std::size_t j = 0; j < y_.blocks(); ++j) {
    scratch_.assign(columns, 0.0);
    for (std::size_t i = 0; i < x_.blocks(); ++i) {
      const SplineWeights& wx = x_.at_block(i);
      for (std::size_t k = 0; k < 4; ++k) scratch_[wx.first + k] += wx.weight[k] * values[j * x_.blocks() + i];
    }
    const SplineWeights& wy = y_.at_block(j);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = 0; i < columns; ++i)
        coefficients[(wy.first + k) * columns + i] += wy.weight[k] * scratch_[i];
  }
}

void SkySpline::evaluate_row(std::span<const double> coefficients, int y, std::span<double> values) const {
  const std::size_t columns = x_.size();
  const SplineWeights wy = y_.at(y);
  scratch_.assign(columns, 0.0);
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < columns; ++i) scratch_[i] += wy.weight[k] * coefficients[(wy.first + k) * columns + i];
  for (std::size_t x = 0; x < values.size(); ++x) {
    const SplineWeights& wx = x_.at_pixel(x);
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) sum += wx.weight[k] * scratch_[wx.first + k];
    values[x] = sum;
  }
}

void SkySpline::solve_gram(std::span<double> coefficients) const {
  const std::size_t columns = x_.size();
  for (std::size_t i = 0; i < columns; ++i) y_.solve_gram(coefficients.data() + i, columns);
  for (std::size_t j = 0; j < y_.size(); ++j) x_.solve_gram(coefficients.data() + j * columns, 1);
}

}  // namespace astroid::detail
