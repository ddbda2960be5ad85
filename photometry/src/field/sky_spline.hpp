// A smooth correction to the sky under a field: a tensor product of cubic B-splines, solved for together with the
// stars.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace astroid::detail {

/// The four cubic B-splines that are not zero at one place, and the first one's index.
struct SplineWeights {
  std::array<double, 4> weight{};
  std::size_t first = 0;
};

/// Uniform cubic B-splines over one axis of n pixels, in cells of about `cell` px; values at the centres of blocks of
/// kBlock px can be taken and collected.
class SplineAxis {
 public:
  static constexpr int kBlock = 8;  // px; a cell's splines hardly change within
  SplineAxis(int pixels, int cell);

  [[nodiscard]] std::size_t size() const { return coefficients_; }
  [[nodiscard]] std::size_t blocks() const { return at_block_.size(); }
  [[nodiscard]] SplineWeights at(double position) const;
  [[nodiscard]] const SplineWeights& at_block(std::size_t i) const { return at_block_[i]; }
  [[nodiscard]] const SplineWeights& at_pixel(std::size_t i) const { return at_pixel_[i]; }
  /// Solves G u = v in place, G the Gram matrix of the splines at the blocks, for elements `stride` apart.
  void solve_gram(double* v, std::size_t stride) const;

 private:
  int pixels_;
  double cells_;
  std::size_t coefficients_;
  std::vector<SplineWeights> at_block_;
  std::vector<SplineWeights> at_pixel_;
  std::vector<std::array<double, 4>> cholesky_;  // row i: elements (i, i-3) … (i, i)
};

/// The tensor product. Coefficients are numbered row by row.
class SkySpline {
 public:
  SkySpline(int nx, int ny, int cell) : x_(nx, cell), y_(ny, cell) {}

  [[nodiscard]] std::size_t size() const { return x_.size() * y_.size(); }
  [[nodiscard]] std::size_t blocks() const { return x_.blocks() * y_.blocks(); }
  [[nodiscard]] std::size_t blocks_x() const { return x_.blocks(); }
  [[nodiscard]] std::size_t columns() const { return x_.size(); }
  [[nodiscard]] const SplineAxis& x() const { return x_; }
  [[nodiscard]] const SplineAxis& y() const { return y_; }

  /// Values at the centres of all blocks. @param values [out] shape (blocks of y, blocks of x)
  void evaluate_blocks(std::span<const double> coefficients, std::span<double> values) const;
  /// Its transpose: adds to each coefficient the values weighted with its spline.
  void collect_blocks(std::span<const double> values, std::span<double> coefficients) const;
  /// Values in the pixels of row y.
  void evaluate_row(std::span<const double> coefficients, int y, std::span<double> values) const;
  /// An approximate inverse of the Gram matrix of blocks of weight 1.
  void solve_gram(std::span<double> coefficients) const;

 private:
  SplineAxis x_;
  SplineAxis y_;
  mutable std::vector<double> scratch_;
};

}  // namespace astroid::detail
