// How well the stars of simulated fields were measured, against the Cramér–Rao bound.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/test/star_field.hpp"

namespace astroid::test {

struct MeasuredStar {
  double x = 0.0;
  double y = 0.0;
  double flux = 0.0;
  double flux_err = 0.0;
};

/// What several fields of the same settings add up to. Stars and detections within 8 px of the edge do not count.
///
/// A star is found by the nearest detection within 1 px that no brighter star took, if their magnitudes differ by less
/// than 0.75. The bound is that of the Fisher matrix of the star's position and flux and those of all stars within 6 px
/// that would be 5 sigma alone, of pixels with the variance of the noiseless image.
class FieldScore {
 public:
  void add(const StarField& field, const StarFieldSettings& settings, std::span<const MeasuredStar> measured);

  [[nodiscard]] double found() const;    ///< share of stars with more than 10 sigma, by their bound
  [[nodiscard]] double bad() const;      ///< share of detections that are no star
  [[nodiscard]] double bias() const;     ///< median relative error of these stars' fluxes
  [[nodiscard]] double scatter() const;  ///< robust, of the flux errors in units of the bound
  /// Robust width of the pulls of found stars of magnitude `mag` ± 0.5. @param count  [out] of them
  [[nodiscard]] double pull_width(double mag, std::size_t& count) const;
  /// Standard deviation of a robust width of `n` normal values, relative; of their median it is 1.2533 / sqrt(n).
  [[nodiscard]] static double width_error(std::size_t n);
  [[nodiscard]] std::size_t stars() const { return expected_; }
  [[nodiscard]] double median_bias_error() const;

 private:
  struct Pull {
    double magnitude, flux, error, flux_err;
  };
  std::size_t expected_ = 0;
  std::size_t hits_ = 0;
  std::size_t detections_ = 0;
  std::size_t bad_ = 0;
  std::vector<double> relative_;
  std::vector<double> in_bounds_;
  std::vector<Pull> pulls_;
};

}  // namespace astroid::test
