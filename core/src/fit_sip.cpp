#include <gsl/gsl_linalg.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "astroid/core/distortion.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr int kNodes = 28;   // Chebyshev points per axis at which the fit is made
constexpr int kChecks = 61;  // points per axis at which it is judged, edges included
constexpr int kFirstOrder = 3;

struct Sample {
  PixelShift real;
  PixelShift ideal;
};

/// Offsets of the detector's edges from the axis, px, pixel edges included.
struct Area {
  double x0, x1, y0, y1;
  [[nodiscard]] PixelShift at(double s, double t) const {  // s, t in [-1, 1]
    return {0.5 * ((x1 + x0) + (x1 - x0) * s), 0.5 * ((y1 + y0) + (y1 - y0) * t)};
  }
};

std::optional<std::vector<Sample>> sample(const Distortion& distortion, const Area& area, int count,
                                          double (*node)(int, int)) {
  std::vector<Sample> samples;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      const PixelShift real = area.at(node(i, count), node(j, count));
      const auto ideal = distortion.undistort(real);
      if (!ideal) return std::nullopt;
      samples.push_back({real, *ideal});
    }
  }
  return samples;
}

/// Least squares by Householder's QR in offsets divided by `scale`, so that powers stay near 1.
SipPolynomial fit(const std::vector<Sample>& samples, int order, double scale) {
  struct Term {
    int i, j;
  };
  std::vector<Term> terms;
  for (int n = 2; n <= order; ++n)
    for (int i = n; i >= 0; --i) terms.push_back({i, n - i});
  const std::size_t rows = samples.size();
  const std::size_t columns = terms.size();
  struct Free {
    void operator()(gsl_matrix* m) const { gsl_matrix_free(m); }
    void operator()(gsl_vector* v) const { gsl_vector_free(v); }
  };
  using Matrix = std::unique_ptr<gsl_matrix, Free>;
  using Vector = std::unique_ptr<gsl_vector, Free>;
  const Matrix matrix(gsl_matrix_alloc(rows, columns));
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      double product = 1.0;
      for (int i = 0; i < terms[c].i; ++i) product *= samples[r].real.dx / scale;
      for (int j = 0; j < terms[c].j; ++j) product *= samples[r].real.dy / scale;
      gsl_matrix_set(matrix.get(), r, c, product);
    }
  }
  const Vector tau(gsl_vector_alloc(columns));
  gsl_linalg_QR_decomp(matrix.get(), tau.get());
  SipPolynomial polynomial(order);
  const Vector right(gsl_vector_alloc(rows));
  const Vector solution(gsl_vector_alloc(columns));
  const Vector residual(gsl_vector_alloc(rows));
  for (const bool x : {true, false}) {
    for (std::size_t r = 0; r < rows; ++r) {
      const Sample& s = samples[r];
      gsl_vector_set(right.get(), r, x ? s.ideal.dx - s.real.dx : s.ideal.dy - s.real.dy);
    }
    gsl_linalg_QR_lssolve(matrix.get(), tau.get(), right.get(), solution.get(), residual.get());
    std::vector<double>& side = x ? polynomial.a : polynomial.b;
    for (std::size_t c = 0; c < columns; ++c) {
      double value = gsl_vector_get(solution.get(), c);
      for (int n = 0; n < terms[c].i + terms[c].j; ++n) value /= scale;
      side[polynomial.index(terms[c].i, terms[c].j)] = value;
    }
  }
  return polynomial;
}

}  // namespace

std::optional<SipFit> fit_sip(const Distortion& distortion, const Rectangle& detector, PixelPosition axis,
                              double tolerance) {
  const Area area{detector.x0 - 0.5 - axis.x, detector.x1() - 0.5 - axis.x, detector.y0 - 0.5 - axis.y,
                  detector.y1() - 0.5 - axis.y};
  const auto nodes = sample(distortion, area, kNodes,
                            [](int k, int n) { return -det::cos(kPi * (static_cast<double>(k) + 0.5) / n); });
  const auto checks =
      sample(distortion, area, kChecks, [](int k, int n) { return 2.0 * static_cast<double>(k) / (n - 1) - 1.0; });
  if (!nodes || !checks) return std::nullopt;
  const double scale = std::max({std::abs(area.x0), std::abs(area.x1), std::abs(area.y0), std::abs(area.y1)});
  SipFit best;
  for (int order = kFirstOrder; order <= SipPolynomial::kHighestOrder; ++order) {
    best.polynomial = fit(*nodes, order, scale);
    const auto fitted = make_sip_distortion(best.polynomial);
    best.worst = 0.0;
    for (const Sample& s : *checks) {
      const auto ideal = fitted->undistort(s.real);
      if (!ideal) return std::nullopt;
      best.worst = std::max(best.worst, det::hypot(ideal->dx - s.ideal.dx, ideal->dy - s.ideal.dy));
    }
    if (best.worst <= tolerance) break;
  }
  return best;
}

}  // namespace astroid
