// What stars that nobody can detect do to the fluxes of those that are detected.
#pragma once

#include <vector>

#include "field/field_solver.hpp"
#include "field/matched_filter.hpp"

namespace astroid::detail {

/// The variance that undetected stars add to a flux, as a share of its variance without them.
///
/// Two kinds are told apart. Those too faint to be detected anywhere make the residuals rougher than their noise; the
/// excess variance of fluxes at places without stars measures their effect directly. Others would be detected alone,
/// but not so near to a brighter star: how many there are follows from the density of detected stars, where they hide
/// from the curvature of chi² in the flux of a second star. What one of them adds counts up to the shift at which it
/// moves the quartiles as far as any outlier, so that the error stays the half-width of the distribution's core.
///
/// @source Condon1974 for confusion noise; differs: measured in the residuals, and hidden companions added.
class HiddenStars {
 public:
  /// @param filter  the significance of residuals after the last fit  @param threshold  of detection, sigma
  HiddenStars(FieldSolver& field, const MatchedFilter& filter, double threshold);

  /// Relative excess of the variance of a star of that flux.
  [[nodiscard]] double excess(double flux) const;

 private:
  void measure_residuals(const FieldSolver& field, const MatchedFilter& filter, double threshold);
  void count_stars(const FieldSolver& field, double threshold);
  struct Class {
    double log_flux = 0.0;
    double excess = 0.0;
  };
  [[nodiscard]] Class make_class(const FieldSolver& field, double flux, double threshold) const;

  double residual_variance_ = 1.0;   // of fluxes at places without stars: 1 where nothing but noise is left
  double pixel_variance_ = 1.0;      // e-², of an empty pixel
  double faintest_ = 0.0;            // e-, detected on empty sky
  double area_ = 1.0;                // px²
  std::vector<double> bin_flux_;     // e-
  std::vector<double> bin_density_;  // stars per px²
  std::vector<Class> classes_;
};

}  // namespace astroid::detail
