// Least squares for the coefficients of an effective PSF, from the residuals of bright stars.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/effective_psf.hpp"
#include "field/field_solver.hpp"

namespace astroid::detail {

struct PsfFitSettings {
  double model_error = 0.01;      ///< share of a star's light in a pixel that the present PSF may be wrong by
  double neighbour_error = 0.05;  ///< the same of its neighbours' light
  int most_iterations = 150;      ///< of conjugate gradients
};

/// The pixels of the chosen stars of a field, what the present PSF leaves in them, and the equations for a better one.
///
/// A star's flux and position change with the PSF: they are eliminated, by projecting the weighted residuals and the
/// PSF's changes on what no change of flux and position makes. So a step is one of Gauss-Newton in all unknowns, and
/// needs no alternation. Coefficients have a prior: a Gaussian of given width, known to half of itself and 2 % of the
/// peak, and smooth on the scale of the grid. @source F141, F142; AndersonKing2000
class PsfFit {
 public:
  /// @param stars  indices in field.stars()  @param prior  of the same grid, order 0
  PsfFit(const FieldSolver& field, std::span<const std::size_t> stars, const EffectivePsf& present,
         const EffectivePsf& prior, const PsfFitSettings& settings);

  /// The PSF of that order (at least that of `present`). @param use  which of the stars count; empty: all
  [[nodiscard]] EffectivePsf solve(int order, std::span<const char> use = {}) const;
  [[nodiscard]] std::size_t usable_pixels() const { return usable_pixels_; }
  /// chi² of every star with another PSF, its flux and position free.
  [[nodiscard]] std::vector<double> chi2(const EffectivePsf& psf) const;

 private:
  static constexpr std::size_t kFree = 3;  // flux, x, y
  struct Star {
    std::array<double, 6> phi{};
    double flux = 0.0;
    int start_x = 0;  // sample of the first spline of the first pixel
    int start_y = 0;
    std::array<double, 4> wx{};
    std::array<double, 4> wy{};
    std::size_t offset = 0;  // of its pixels
  };
  void add_star(const FieldSolver& field, std::size_t index, const PsfFitSettings& settings);
  /// sqrt(w) F A c, projected. @param plane  coefficients at the star's place
  void forward(const Star& star, std::span<const double> plane, std::span<double> pixels) const;
  /// Adds F A^T sqrt(w) v to a plane.
  void backward(const Star& star, std::span<const double> pixels, std::span<double> plane) const;
  void project(const Star& star, std::span<double> pixels) const;
  void combine(const Star& star, std::span<const double> coefficients, std::size_t terms,
               std::vector<double>& plane) const;
  void multiply(std::span<const double> v, std::size_t terms, std::span<const char> use, std::span<double> product) const;
  [[nodiscard]] std::vector<double> diagonal(std::size_t terms, std::span<const char> use) const;
  void add_prior(std::span<const double> v, std::size_t terms, std::span<double> product) const;

  EffectivePsf present_;
  EffectivePsf prior_;
  int half_;            // px, of a star's box
  std::size_t side_;    // px
  int most_iterations_;
  std::size_t usable_pixels_ = 0;
  std::vector<Star> stars_;
  std::vector<double> root_weight_;
  std::vector<double> residual_;  // times the root of the weight, projected
  std::vector<double> basis_;     // kFree planes a star, orthonormal
  std::vector<double> precision_; // of the prior's coefficients
};

}  // namespace astroid::detail
