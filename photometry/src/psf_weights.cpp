#include "psf_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"

namespace astroid::detail {

namespace {

// A doubt with less than this share of the noise in every combination of pixels changes no variance by more.
constexpr double kNegligibleDoubt = 1e-4;

// Share of an isolated star's information below which rounding (1e-16) would speak, not the pixels: sigma grew a
// million times.
constexpr double kLeastInformation = 1e-12;

// Several running sums hide the latency of addition; their number and the order in which they meet are fixed.
constexpr std::size_t kLanes = 4;

double dot(const double* a, const double* b, std::size_t n) {
  std::array<double, kLanes> lanes{};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] += a[i + lane] * b[i + lane];
  for (; i < n; ++i) lanes[i % kLanes] += a[i] * b[i];
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

// The doubts in units of the pixels' noise, row after row, those that matter; returns their number.
std::size_t whiten(const PsfWindow& window, PsfScratch& scratch) {
  const std::size_t pixels = window.fractions.size();
  scratch.doubts.resize(window.doubts.size());
  std::size_t rows = 0;
  for (std::size_t from = 0; from < window.doubts.size(); from += pixels) {
    double* row = scratch.doubts.data() + rows * pixels;
    for (std::size_t i = 0; i < pixels; ++i) row[i] = window.doubts[from + i] * scratch.inverse_sigma[i];
    if (dot(row, row, pixels) >= kNegligibleDoubt) ++rows;
  }
  return rows;
}

// Lower triangle of L with L L^T = 1 + A A^T, in the rows of `matrix`.
void factorise(const std::vector<double>& a, std::size_t rows, std::size_t pixels, std::vector<double>& matrix) {
  matrix.resize(rows * rows);
  for (std::size_t k = 0; k < rows; ++k) {
    double* row = matrix.data() + k * rows;
    for (std::size_t l = 0; l < k; ++l) {
      const double* pivot_row = matrix.data() + l * rows;
      const double product = dot(a.data() + k * pixels, a.data() + l * pixels, pixels);
      row[l] = (product - dot(row, pivot_row, l)) / pivot_row[l];
    }
    const double square = dot(a.data() + k * pixels, a.data() + k * pixels, pixels);
    // No pivot is below 1, since the matrix is 1 and something positive; rounding must not tell otherwise.
    row[k] = std::sqrt(std::max(1.0, 1.0 + (square - dot(row, row, k))));
  }
}

void solve(const std::vector<double>& matrix, std::size_t rows, std::vector<double>& x) {
  for (std::size_t k = 0; k < rows; ++k) {
    const double* row = matrix.data() + k * rows;
    x[k] = (x[k] - dot(row, x.data(), k)) / row[k];
  }
  for (std::size_t k = rows; k-- > 0;) {
    const double* row = matrix.data() + k * rows;
    x[k] /= row[k];
    for (std::size_t l = 0; l < k; ++l) x[l] -= row[l] * x[k];
  }
}

}  // namespace

PsfErrors psf_weights(const PsfWindow& window, std::span<double> weights, PsfScratch& scratch) {
  const std::size_t pixels = window.fractions.size();
  ASTROID_CHECK_EQ(window.variance.size(), pixels);
  ASTROID_CHECK_EQ(weights.size(), pixels);
  scratch.inverse_sigma.resize(pixels);
  scratch.star.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    scratch.inverse_sigma[i] = window.variance[i] > 0.0 ? 1.0 / std::sqrt(window.variance[i]) : 0.0;
    scratch.star[i] = window.fractions[i] * scratch.inverse_sigma[i];
  }
  const std::size_t rows = pixels > 0 ? whiten(window, scratch) : 0;
  factorise(scratch.doubts, rows, pixels, scratch.matrix);
  scratch.solution.resize(rows);
  for (std::size_t k = 0; k < rows; ++k)
    scratch.solution[k] = dot(scratch.doubts.data() + k * pixels, scratch.star.data(), pixels);
  solve(scratch.matrix, rows, scratch.solution);

  // What of the star's light is not explained by a mistake in the doubted light: sqrt(V) C^-1 p.
  scratch.residual = scratch.star;
  for (std::size_t k = 0; k < rows; ++k) {
    const double* row = scratch.doubts.data() + k * pixels;
    for (std::size_t i = 0; i < pixels; ++i) scratch.residual[i] -= scratch.solution[k] * row[i];
  }
  const double known = dot(scratch.star.data(), scratch.star.data(), pixels);
  const double information = dot(scratch.star.data(), scratch.residual.data(), pixels);
  // Also stops what is not a number, and a star too faint for its square.
  if (!(information > kLeastInformation * known && std::isfinite(1.0 / information))) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::fill(weights.begin(), weights.end(), 0.0);
    return {kInfinity, kInfinity, kInfinity};
  }
  for (std::size_t i = 0; i < pixels; ++i) weights[i] = scratch.residual[i] * scratch.inverse_sigma[i] / information;
  const double noise = dot(scratch.residual.data(), scratch.residual.data(), pixels);
  const double doubt = dot(scratch.solution.data(), scratch.solution.data(), rows);
  return {std::sqrt(noise) / information, std::sqrt(doubt) / information, 1.0 / std::sqrt(known)};
}

}  // namespace astroid::detail
