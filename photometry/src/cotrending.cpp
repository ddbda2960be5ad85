#include "astroid/photometry/cotrending.hpp"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

struct FreeMatrix {
  void operator()(gsl_matrix* m) const { gsl_matrix_free(m); }
};
struct FreeVector {
  void operator()(gsl_vector* v) const { gsl_vector_free(v); }
};
using Matrix = std::unique_ptr<gsl_matrix, FreeMatrix>;
using Vector = std::unique_ptr<gsl_vector, FreeVector>;

bool is_whole(std::span<const float> series) {
  return std::ranges::all_of(series, [](float value) { return std::isfinite(value); });
}

double mean_of(std::span<const float> series) {
  double sum = 0.0;
  for (const float value : series) sum += static_cast<double>(value);
  return sum / static_cast<double>(series.size());
}

/// Eigenvectors of a symmetric matrix, the largest eigenvalue first.
struct Eigensystem {
  Vector values;
  Matrix vectors;

  explicit Eigensystem(gsl_matrix& matrix)
      : values(gsl_vector_alloc(matrix.size1)), vectors(gsl_matrix_alloc(matrix.size1, matrix.size1)) {
    gsl_eigen_symmv_workspace* workspace = gsl_eigen_symmv_alloc(matrix.size1);
    gsl_eigen_symmv(&matrix, values.get(), vectors.get(), workspace);
    gsl_eigen_symmv_free(workspace);
    gsl_eigen_symmv_sort(values.get(), vectors.get(), GSL_EIGEN_SORT_VAL_DESC);
  }
};

/// Appends a series about its mean in units of its noise. A star that varies by itself gets no more weight than one
/// that shows what is common as strongly.
void append_scaled(std::span<const float> series, double noise, std::vector<double>& scaled) {
  const double mean = mean_of(series);
  double square = 0.0;
  for (const float value : series) {
    scaled.push_back((static_cast<double>(value) - mean) / noise);
    square += scaled.back() * scaled.back() / static_cast<double>(series.size());
  }
  const double weight = 1.0 / std::sqrt(std::max(1.0, square));
  for (double& value : std::span(scaled).last(series.size())) value *= weight;
}

/// Z Z^T, or Z^T Z, of Z with shape (rows, columns).
Matrix product(std::span<const double> z, std::size_t rows, std::size_t columns, bool over_rows) {
  const std::size_t size = over_rows ? rows : columns;
  Matrix matrix(gsl_matrix_calloc(size, size));
  if (over_rows) {
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (std::size_t k = 0; k < columns; ++k) sum += z[i * columns + k] * z[j * columns + k];
        gsl_matrix_set(matrix.get(), i, j, sum);
      }
  } else {
    for (std::size_t k = 0; k < rows; ++k)
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          *gsl_matrix_ptr(matrix.get(), i, j) += z[k * columns + i] * z[k * columns + j];
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j) gsl_matrix_set(matrix.get(), j, i, gsl_matrix_get(matrix.get(), i, j));
  return matrix;
}

}  // namespace

CommonTrends::CommonTrends(std::span<const float> series, std::span<const double> noise, std::size_t bins,
                           std::size_t most)
    : bins_(bins) {
  ASTROID_CHECK_EQ(series.size(), noise.size() * bins);
  if (bins < 3 || most == 0) return;  // a mean and a trend leave nothing to judge them by
  std::vector<double> scaled;         // [reference][bin]
  for (std::size_t star = 0; star < noise.size(); ++star) {
    const std::span<const float> one = series.subspan(star * bins, bins);
    if (noise[star] > 0.0 && std::isfinite(noise[star]) && is_whole(one)) append_scaled(one, noise[star], scaled);
  }
  references_ = scaled.size() / bins;
  if (references_ < 2) return;  // nothing is common to one
  // Z^T Z and Z Z^T have the same eigenvalues: the smaller one is solved.
  const bool over_stars = references_ < bins;
  const std::size_t size = over_stars ? references_ : bins;
  const Eigensystem system(*product(scaled, references_, bins, over_stars));
  const auto stars = static_cast<double>(references_);
  constexpr double kMargin = 1.2;  // for edges of finite matrices
  edge_ = kMargin * std::pow(1.0 + std::sqrt(static_cast<double>(bins) / stars), 2);
  for (std::size_t k = 0; k < size; ++k) eigenvalues_.push_back(gsl_vector_get(system.values.get(), k) / stars);
  for (std::size_t k = 0; k < std::min({most, bins - 2, size}); ++k) {
    const double value = gsl_vector_get(system.values.get(), k);
    if (!(value > edge_ * stars)) break;
    for (std::size_t b = 0; b < bins; ++b) {
      double component = 0.0;
      if (over_stars) {
        for (std::size_t star = 0; star < references_; ++star)
          component += gsl_matrix_get(system.vectors.get(), star, k) * scaled[star * bins + b] / std::sqrt(value);
      } else {
        component = gsl_matrix_get(system.vectors.get(), b, k);
      }
      trends_.push_back(component * std::sqrt(static_cast<double>(bins)));
    }
  }
}

TrendFit CommonTrends::fit(std::span<const float> series) const {
  ASTROID_CHECK_EQ(series.size(), bins_);
  const std::size_t unknowns = trends() + 1;
  TrendFit result;
  result.amplitude.assign(trends(), 0.0);
  result.rms_before = result.rms_after = std::numeric_limits<double>::quiet_NaN();
  Matrix normal(gsl_matrix_calloc(unknowns, unknowns));
  Vector right(gsl_vector_calloc(unknowns));
  const auto base = [&](std::size_t k, std::size_t bin) { return k == 0 ? 1.0 : trend(k - 1)[bin]; };
  std::size_t used = 0;
  double sum = 0.0;
  for (std::size_t bin = 0; bin < bins_; ++bin) {
    const auto value = static_cast<double>(series[bin]);
    if (!std::isfinite(value)) continue;
    ++used;
    sum += value;
    for (std::size_t i = 0; i < unknowns; ++i) {
      *gsl_vector_ptr(right.get(), i) += base(i, bin) * value;
      for (std::size_t j = 0; j < unknowns; ++j) *gsl_matrix_ptr(normal.get(), i, j) += base(i, bin) * base(j, bin);
    }
  }
  if (used == 0) return result;
  result.constant = sum / static_cast<double>(used);
  const auto rms_about_fit = [&](std::size_t freedom) {
    double squares = 0.0;
    for (std::size_t bin = 0; bin < bins_; ++bin) {
      const auto value = static_cast<double>(series[bin]);
      if (!std::isfinite(value)) continue;
      const double left = value - result.constant - at(result, bin);
      squares += left * left;
    }
    return std::sqrt(squares / static_cast<double>(used - freedom));
  };
  if (used > 1) result.rms_before = rms_about_fit(1);
  if (used <= unknowns) return result;
  // Bins that are missing may leave trends that look alike: a ridge far below what a whole series has.
  constexpr double kRidge = 1e-9;
  for (std::size_t i = 0; i < unknowns; ++i) *gsl_matrix_ptr(normal.get(), i, i) += kRidge * static_cast<double>(used);
  Vector solution(gsl_vector_alloc(unknowns));
  gsl_linalg_cholesky_decomp1(normal.get());
  gsl_linalg_cholesky_solve(normal.get(), right.get(), solution.get());
  result.constant = gsl_vector_get(solution.get(), 0);
  for (std::size_t k = 0; k + 1 < unknowns; ++k) result.amplitude[k] = gsl_vector_get(solution.get(), k + 1);
  result.rms_after = rms_about_fit(unknowns);
  return result;
}

double CommonTrends::at(const TrendFit& fit, std::size_t bin) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < trends(); ++k) sum += fit.amplitude[k] * trend(k)[bin];
  return sum;
}

}  // namespace astroid
