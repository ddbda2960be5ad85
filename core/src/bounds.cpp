#include "astroid/core/bounds.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kParameters = 4;
using Matrix = std::array<std::array<double, kParameters>, kParameters>;
using Vector = std::array<double, kParameters>;

// A pixel without star and background has no variance and, with no signal, tells nothing.
double information(double derivative, double variance) {
  return variance > 0.0 ? derivative * derivative / variance : 0.0;
}

// Cholesky of the matrix scaled to a unit diagonal; false when it is singular to working precision.
bool invert(const Matrix& fisher, Matrix& inverse) {
  constexpr double kSingular = 1e-14;  // pivot of the scaled matrix, a few rounding errors
  Vector scale{};
  for (std::size_t i = 0; i < kParameters; ++i) {
    if (!(fisher[i][i] > 0.0)) return false;
    scale[i] = 1.0 / std::sqrt(fisher[i][i]);
  }
  Matrix lower{};
  for (std::size_t i = 0; i < kParameters; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = fisher[i][j] * scale[i] * scale[j];
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      if (i != j) {
        lower[i][j] = sum / lower[j][j];
      } else if (sum > kSingular) {
        lower[i][i] = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  for (std::size_t column = 0; column < kParameters; ++column) {
    Vector x{};
    for (std::size_t i = 0; i < kParameters; ++i) {
      double sum = i == column ? 1.0 : 0.0;
      for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * x[k];
      x[i] = sum / lower[i][i];
    }
    for (std::size_t i = kParameters; i-- > 0;) {
      double sum = x[i];
      for (std::size_t k = i + 1; k < kParameters; ++k) sum -= lower[k][i] * x[k];
      x[i] = sum / lower[i][i];
    }
    for (std::size_t i = 0; i < kParameters; ++i) inverse[i][column] = x[i] * scale[i] * scale[column];
  }
  return true;
}

}  // namespace

double noise_equivalent_area(std::span<const double> fractions) {
  double sum = 0.0;
  for (const double p : fractions) sum += p * p;
  return 1.0 / sum;
}

double flux_bound(std::span<const double> fractions, const SourceOnBackground& star) {
  double sum = 0.0;
  for (const double p : fractions) sum += information(p, star.electrons * p + star.background);
  return 1.0 / std::sqrt(sum);
}

double position_bound(std::span<const double> fractions, std::span<const double> gradient,
                      const SourceOnBackground& star) {
  ASTROID_CHECK_EQ(fractions.size(), gradient.size());
  double sum = 0.0;
  for (std::size_t n = 0; n < fractions.size(); ++n) {
    sum += information(star.electrons * gradient[n], star.electrons * fractions[n] + star.background);
  }
  return 1.0 / std::sqrt(sum);
}

JointBounds joint_bounds(std::span<const double> fractions, std::span<const double> dpdx, std::span<const double> dpdy,
                         const SourceOnBackground& star) {
  ASTROID_CHECK_EQ(fractions.size(), dpdx.size());
  ASTROID_CHECK_EQ(fractions.size(), dpdy.size());
  Matrix fisher{};
  for (std::size_t n = 0; n < fractions.size(); ++n) {
    const double variance = star.electrons * fractions[n] + star.background;
    if (!(variance > 0.0)) continue;
    const Vector derivative = {fractions[n], star.electrons * dpdx[n], star.electrons * dpdy[n], 1.0};
    for (std::size_t i = 0; i < kParameters; ++i) {
      for (std::size_t j = 0; j < kParameters; ++j) fisher[i][j] += derivative[i] * derivative[j] / variance;
    }
  }
  JointBounds bounds;
  if (!invert(fisher, bounds.covariance)) {
    for (std::size_t i = 0; i < kParameters; ++i) bounds.covariance[i][i] = kInfinity;
  }
  bounds.flux = std::sqrt(bounds.covariance[0][0]);
  bounds.x = std::sqrt(bounds.covariance[1][1]);
  bounds.y = std::sqrt(bounds.covariance[2][2]);
  bounds.background = std::sqrt(bounds.covariance[3][3]);
  return bounds;
}

}  // namespace astroid
