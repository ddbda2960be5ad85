#include "astroid/analysis/focal_plane.hpp"

#include <gsl/gsl_multifit.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "astroid/analysis/confidence.hpp"
#include "astroid/core/statistics/regression.hpp"

namespace astroid {

namespace {

constexpr double kTwoSigma = 1.96;  // half a 95 % interval of a normal distribution

/// The noise at the reference magnitude from that of stars near it.
FocalPlaneValue at_reference(const std::vector<double>& offsets, const std::vector<double>& log_noise) {
  const Line line = fit_line(offsets, log_noise);
  if (line.used == 0) return {};
  const double value = line.used > 1 && std::isfinite(line.slope) ? line(0.0) : log_noise.front();
  const double away = line.slope_error * line.centre;
  const double error = std::hypot(line.at_centre_error, away);
  return {std::exp(value), std::exp(value) * error};
}

struct MatrixFree {
  void operator()(gsl_matrix* m) const { gsl_matrix_free(m); }
};
struct VectorFree {
  void operator()(gsl_vector* v) const { gsl_vector_free(v); }
};
struct FitFree {
  void operator()(gsl_multifit_linear_workspace* w) const { gsl_multifit_linear_free(w); }
};
using Matrix = std::unique_ptr<gsl_matrix, MatrixFree>;
using Vector = std::unique_ptr<gsl_vector, VectorFree>;
using Fit = std::unique_ptr<gsl_multifit_linear_workspace, FitFree>;

}  // namespace

SubFieldMetrics sub_field_metrics(const Rectangle& area, std::span<const TargetMetrics> targets,
                                  double reference_magnitude, const RunSetup& setup) {
  SubFieldMetrics metrics;
  metrics.area = area;
  metrics.x = area.x0 + 0.5 * (area.nx - 1);
  metrics.y = area.y0 + 0.5 * (area.ny - 1);
  metrics.targets = static_cast<std::int64_t>(targets.size());
  std::vector<double> offsets;
  std::vector<double> predicted;
  std::vector<double> measured_offsets;
  std::vector<double> measured;
  std::vector<double> spr;
  std::vector<double> residual;
  for (const TargetMetrics& target : targets) {
    const double offset = target.mag - reference_magnitude;
    if (std::abs(offset) > kNearReference || !is_clean(target)) continue;
    ++metrics.clean;
    spr.push_back(target.spr_tot);
    if (is_uncontaminated(target, setup)) residual.push_back(target.causes.residual);
    if (target.nsr_1h_ppm > 0.0) {
      offsets.push_back(offset);
      predicted.push_back(std::log(target.nsr_1h_ppm));
    }
    // Short series show the noise within a bin only: its ratio to the prediction stands for that of all noise.
    const double ratio = target.nsr_1h_within_measured.value / target.predicted.bin_within;
    if (ratio > 0.0 && target.nsr_1h_ppm > 0.0) {
      measured_offsets.push_back(offset);
      measured.push_back(std::log(ratio * target.nsr_1h_ppm));
    }
  }
  metrics.nsr_predicted = at_reference(offsets, predicted);
  metrics.nsr_measured = at_reference(measured_offsets, measured);
  const MedianEstimate pollution = median_estimate(spr);
  metrics.spr = {pollution.value, pollution.half_width() / kTwoSigma};
  const MeanEstimate difference = mean_estimate(residual);
  metrics.recovery = {difference.value, difference.error};
  return metrics;
}

FocalPlaneSurface::FocalPlaneSurface(std::span<const FocalPlanePoint> points, const Rectangle& detector)
    : centre_x_(detector.x0 + 0.5 * (detector.nx - 1)),
      centre_y_(detector.y0 + 0.5 * (detector.ny - 1)),
      per_half_x_(2.0 / std::max(1, detector.nx - 1)),
      per_half_y_(2.0 / std::max(1, detector.ny - 1)) {
  const auto has_error = [](const FocalPlanePoint& p) { return std::isfinite(p.is.error) && p.is.error > 0.0; };
  const bool weighted = std::ranges::any_of(points, has_error);
  std::vector<FocalPlanePoint> known;
  for (const FocalPlanePoint& point : points)
    if (std::isfinite(point.is.value) && (!weighted || has_error(point))) known.push_back(point);
  const std::size_t n = known.size();
  if (n == 0) return;
  constexpr std::size_t kForQuadratic = 9;
  constexpr std::size_t kForPlane = 4;
  degree_ = n >= kForQuadratic ? 2 : n >= kForPlane ? 1 : 0;
  constexpr std::size_t kTerms[] = {1, 3, 6};
  count_ = kTerms[degree_];

  const Matrix design(gsl_matrix_alloc(n, count_));
  const Vector values(gsl_vector_alloc(n));
  const Vector weights(gsl_vector_alloc(n));
  const Vector coefficients(gsl_vector_alloc(count_));
  const Matrix covariance(gsl_matrix_alloc(count_, count_));
  for (std::size_t i = 0; i < n; ++i) {
    const auto t = terms(known[i].x, known[i].y);
    for (std::size_t k = 0; k < count_; ++k) gsl_matrix_set(design.get(), i, k, t[k]);
    gsl_vector_set(values.get(), i, known[i].is.value);
    gsl_vector_set(weights.get(), i, weighted ? 1.0 / (known[i].is.error * known[i].is.error) : 1.0);
  }
  const Fit fit(gsl_multifit_linear_alloc(n, count_));
  double chi2 = 0.0;
  // The singular value decomposition leaves out what the points do not determine, such as a slope across one column.
  gsl_multifit_wlinear(design.get(), weights.get(), values.get(), coefficients.get(), covariance.get(), &chi2,
                       fit.get());
  const double freedom = static_cast<double>(n) - static_cast<double>(count_);
  const double scatter = freedom > 0.0 ? chi2 / freedom : std::numeric_limits<double>::quiet_NaN();
  const double scale = weighted ? std::max(1.0, std::isnan(scatter) ? 1.0 : scatter) : scatter;
  for (std::size_t k = 0; k < count_; ++k) {
    coefficients_[k] = gsl_vector_get(coefficients.get(), k);
    for (std::size_t l = 0; l < count_; ++l) covariance_[k][l] = scale * gsl_matrix_get(covariance.get(), k, l);
  }
}

std::array<double, FocalPlaneSurface::kMostTerms> FocalPlaneSurface::terms(double x, double y) const {
  const double u = (x - centre_x_) * per_half_x_;
  const double v = (y - centre_y_) * per_half_y_;
  return {1.0, u, v, u * u, u * v, v * v};
}

FocalPlaneValue FocalPlaneSurface::operator()(double x, double y) const {
  if (degree_ < 0) return {};
  const auto t = terms(x, y);
  double value = 0.0;
  double variance = 0.0;
  for (std::size_t k = 0; k < count_; ++k) {
    value += coefficients_[k] * t[k];
    for (std::size_t l = 0; l < count_; ++l) variance += t[k] * covariance_[k][l] * t[l];
  }
  return {value, std::sqrt(std::max(0.0, variance))};
}

}  // namespace astroid
