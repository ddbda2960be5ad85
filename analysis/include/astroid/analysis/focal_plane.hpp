// From sub-fields spread over the detector to smooth surfaces over the whole focal plane.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/core/image.hpp"

namespace astroid {

/// A value and its standard error; NaN where nothing is known.
struct FocalPlaneValue {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();
};

/// What the clean targets of one sub-field say of its place.
struct SubFieldMetrics {
  Rectangle area;
  double x = 0.0, y = 0.0;        ///< its centre, px
  std::int64_t targets = 0;       ///< in it
  std::int64_t clean = 0;         ///< of them, near the reference magnitude, whose flux means what it says
  FocalPlaneValue nsr_predicted;  ///< ppm in one bin with all cameras, of a star of the reference magnitude
  FocalPlaneValue nsr_measured;   ///< the same times measured over predicted noise within bins
  FocalPlaneValue spr;            ///< median stellar pollution ratio
  FocalPlaneValue recovery;       ///< mean of measured - true magnitude that contamination and aperture do not explain
};

/// Targets within `kNearReference` of the reference magnitude; their noise is taken to it by a straight line in
/// log noise against magnitude.
inline constexpr double kNearReference = 1.0;  // mag
SubFieldMetrics sub_field_metrics(const Rectangle& area, std::span<const TargetMetrics> targets,
                                  double reference_magnitude, const RunSetup& setup);

/// A point of a surface.
struct FocalPlanePoint {
  double x = 0.0, y = 0.0;  ///< px
  FocalPlaneValue is;
};

/// A polynomial over the detector, by weighted least squares: quadratic from nine points on, a plane from four, else
/// the weighted mean. Points without a value are left out, and where some have errors those that have none; without
/// any errors all count the same.
///
/// Errors are those of the fit, increased where the points scatter more than theirs explain (chi² per degree of freedom
/// above 1): what the surface cannot follow is in them.
/// @accuracy  a quadratic is found to rounding (test: FocalPlaneSurface.FindsAQuadraticExactly).
class FocalPlaneSurface {
 public:
  FocalPlaneSurface(std::span<const FocalPlanePoint> points, const Rectangle& detector);
  [[nodiscard]] FocalPlaneValue operator()(double x, double y) const;
  [[nodiscard]] int degree() const { return degree_; }  ///< -1 without points

 private:
  static constexpr std::size_t kMostTerms = 6;
  [[nodiscard]] std::array<double, kMostTerms> terms(double x, double y) const;

  double centre_x_, centre_y_, per_half_x_, per_half_y_;
  int degree_ = -1;
  std::size_t count_ = 0;
  std::array<double, kMostTerms> coefficients_{};
  std::array<std::array<double, kMostTerms>, kMostTerms> covariance_{};
};

}  // namespace astroid
