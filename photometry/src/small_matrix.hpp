// Dense symmetric matrices of a few rows.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace astroid::detail {

/// Inverse, row by row, of the symmetric matrix with elements 00, 01, 02, 11, 12, 22; zero if it has none.
inline std::array<double, 9> inverse_of_symmetric(const std::array<double, 6>& m) {
  const double a = m[3] * m[5] - m[4] * m[4];
  const double b = m[2] * m[4] - m[1] * m[5];
  const double c = m[1] * m[4] - m[2] * m[3];
  const double determinant = m[0] * a + m[1] * b + m[2] * c;
  if (!(determinant > 0.0)) return {};
  const double s = 1.0 / determinant;
  const double d = s * (m[0] * m[5] - m[2] * m[2]);
  const double e = s * (m[1] * m[2] - m[0] * m[4]);
  const double f = s * (m[0] * m[3] - m[1] * m[1]);
  return {s * a, s * b, s * c, s * b, d, e, s * c, e, f};
}

/// The diagonal of a factor's row that was taken out.
inline constexpr double kTakenOut = 1e150;

/// Cholesky factor of a symmetric n × n matrix, in place in the lower triangle. Rows whose diagonal loses more than
/// 1 - `least` of itself to those before have no information of their own: they are taken out (their factor is zero
/// but for kTakenOut on the diagonal).
inline void cholesky(std::span<double> m, std::size_t n, double least) {
  for (std::size_t j = 0; j < n; ++j) {
    double diagonal = m[j * n + j];
    const double given = diagonal;
    for (std::size_t k = 0; k < j; ++k) diagonal -= m[j * n + k] * m[j * n + k];
    if (!(diagonal > least * given)) {
      for (std::size_t k = 0; k < j; ++k) m[j * n + k] = 0.0;
      m[j * n + j] = kTakenOut;
    } else {
      m[j * n + j] = std::sqrt(diagonal);
    }
    const double scale = 1.0 / m[j * n + j];
    for (std::size_t i = j + 1; i < n; ++i) {
      double sum = m[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
      m[i * n + j] = sum * scale;
    }
  }
}

/// Solves L u = v in place.
inline void solve_lower(std::span<const double> factor, std::size_t n, std::span<double> v) {
  for (std::size_t i = 0; i < n; ++i) {
    double sum = v[i];
    for (std::size_t k = 0; k < i; ++k) sum -= factor[i * n + k] * v[k];
    v[i] = sum / factor[i * n + i];
  }
}

}  // namespace astroid::detail
