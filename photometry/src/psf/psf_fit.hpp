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

/// By how much of a star's light in a pixel the PSF seems to be wrong, from the residuals in the stars' cores: with it
/// 95 % of them are within two sigma, as normal ones are. @param stars  indices in field.stars()  @source F145
double psf_misfit(const FieldSolver& field, std::span<const std::size_t> stars);

struct PsfFitSettings {
  double model_error = 0.01;      ///< share of a star's light in a pixel that the present PSF may be wrong by
  double neighbour_error = 0.05;  ///< the same of its neighbours' light
  double tolerance = 1e-3;        ///< of conjugate gradients: the residual's norm
  int most_iterations = 150;      ///< of them
  double window = 1.0;            ///< px, sigma of the window of the centroid that is held at 0
  std::size_t whole_stars = 150;  ///< the brightest, whose wings count; of the others only the core does
};

/// How free a PSF is.
struct PsfFreedom {
  int order = 0;            ///< of its variation over the field
  double from_prior = 1.0;  ///< how far it may be from the prior, relative to what the prior may be wrong by
};

/// The pixels of the chosen stars of a field, what the present PSF leaves in them, and the equations for a better one.
///
/// A star's flux and position change with the PSF: they are eliminated, by projecting the weighted residuals and the
/// PSF's changes on what no change of flux and position makes. So a step is one of Gauss-Newton in all unknowns, and
/// needs no alternation. Coefficients have a prior: a Gaussian of given width, known to half of itself and 2 % of the
/// peak, and smooth on the scale of the grid; the flux and the centroid of every term are held. @source F141, F142;
/// AndersonKing2000
class PsfFit {
 public:
  /// @param stars  indices in field.stars()  @param prior  of the same grid, order 0
  PsfFit(const FieldSolver& field, std::span<const std::size_t> stars, const EffectivePsf& present,
         const EffectivePsf& prior, const PsfFitSettings& settings);

  /// The PSF of that order (at least that of `present`). @param use  which of the stars count; empty: all
  [[nodiscard]] EffectivePsf solve(const PsfFreedom& freedom, std::span<const char> use = {}) const;
  [[nodiscard]] std::size_t usable_pixels() const { return usable_pixels_; }
  /// chi² of every star with another PSF, its flux and position free.
  [[nodiscard]] std::vector<double> chi2(const EffectivePsf& psf) const;

 private:
  static constexpr std::size_t kFree = 3;  // flux, x, y
  struct Star {
    std::array<double, 6> phi{};
    double flux = 0.0;
    int side = 0;     // px, of its box
    int start_x = 0;  // padded sample of the first spline of the first pixel
    int start_y = 0;
    std::array<double, 4> wx{};
    std::array<double, 4> wy{};
    std::size_t offset = 0;  // of its pixels
    [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }
  };
  void add_star(const FieldSolver& field, std::size_t index, int half, const PsfFitSettings& settings);
  [[nodiscard]] std::span<const double> of(const Star& star, const std::vector<double>& values) const;
  /// sqrt(w) F A c. @param phases  coefficients at the star's place, as spread_phases() lays them out
  void forward(const Star& star, std::span<const double> phases, std::span<double> pixels) const;
  /// Adds F A^T sqrt(w) v.
  void backward(const Star& star, std::span<const double> pixels, std::span<double> phases) const;
  void project(const Star& star, std::span<double> pixels) const;
  /// The sum over the terms at a star's place.
  void combine(const Star& star, std::span<const double> phases, std::size_t terms, std::span<double> sum) const;
  /// Its transpose; leaves zeros where the sum was.
  void add_terms(const Star& star, std::span<double> sum, std::size_t terms, std::span<double> phases) const;
  /// Calls with the begin and the length of every run of samples that the star's pixels need.
  template <class Visit>
  void for_each_run(const Star& star, Visit visit) const;
  [[nodiscard]] std::vector<double> spread(std::span<const double> coefficients, std::size_t terms) const;
  void gather(std::span<const double> phases, std::size_t terms, std::span<double> coefficients) const;
  [[nodiscard]] std::size_t place(int x, int y) const;
  void multiply(std::span<const double> v, std::span<const double> prior, std::span<const char> use,
                std::span<double> product) const;
  [[nodiscard]] std::vector<double> diagonal(std::span<const double> prior, std::span<const char> use) const;
  /// @param prior  weight of every term
  void add_prior(std::span<const double> v, std::span<const double> prior, std::span<double> product) const;

  /// Holds fluxes and places where they are: the data say nothing of them.
  void add_gauge(std::span<const double> v, std::size_t terms, std::span<double> product) const;

  EffectivePsf present_;
  EffectivePsf prior_;
  PsfFitSettings settings_;
  // Samples that are a whole number of pixels apart are side by side in memory: a row of the grid is samples_per_pixel
  // runs of `run_` samples, with zeros for `pad_` samples around the grid.
  int pad_;
  int rows_;
  std::size_t run_;
  std::size_t usable_pixels_ = 0;
  std::vector<Star> stars_;
  std::vector<double> root_weight_;
  std::vector<double> residual_;   // times the root of the weight, projected
  std::vector<double> basis_;      // kFree planes a star, orthonormal
  std::vector<double> precision_;  // of the prior's coefficients
  std::array<std::vector<double>, 3> gauge_;
  mutable std::vector<double> scratch_;
};

template <class Visit>
void PsfFit::for_each_run(const Star& star, Visit visit) const {
  const int step = present_.samples_per_pixel;
  const int last_x = star.start_x + step * (star.side - 1) + 3;
  const int last_y = star.start_y + step * (star.side - 1) + 3;
  const auto first = static_cast<std::size_t>(star.start_x / step);
  const std::size_t length = static_cast<std::size_t>(last_x / step) + 1 - first;
  for (int y = star.start_y; y <= last_y; ++y)
    for (int phase = 0; phase < step; ++phase) visit(place(phase, y) + first, length);
}

}  // namespace astroid::detail
