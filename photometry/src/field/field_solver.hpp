// All stars of a field and its sky at once: Gauss-Newton steps on positions, fluxes and the coefficients of the sky.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/psf.hpp"
#include "field/neighbours.hpp"
#include "field/padded_plane.hpp"
#include "field/sky_spline.hpp"
#include "field/star_stamps.hpp"

namespace astroid::detail {

/// What is measured: the pixels of a field in electrons, and what is known of their noise.
struct FieldPixels {
  PaddedPlane electrons;       ///< 0 where there is nothing to see
  PaddedPlane usable;          ///< 1, or 0 in the margin and where a pixel is masked
  PaddedPlane sky;             ///< a first estimate, e- per pixel
  double read_variance = 0.0;  ///< e-² per pixel, of all that is not the photon noise of sky and stars
  bool any = false;            ///< whether any pixel is usable
};

/// The curvature of chi² / 2 in one star's flux, x and y, and its slope.
struct StarTerms {
  std::array<double, 6> curvature{};  ///< FF, Fx, Fy, xx, xy, yy
  std::array<double, 3> slope{};      ///< sum w r dm/d(F, x, y)
  std::array<double, 3> sky{};        ///< sum w dm/d(F, x, y): what couples it to the sky
};

/// Curvature between two stars: element 3 a + b is that of parameter a of the first and b of the second.
struct PairTerms {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  std::array<double, 9> curvature{};
};

/// The model of a field, and the chi² of its pixels to second order about it.
///
/// Pixels have the weight of the noise that the model expects in them, not the noise that the data show: with weights
/// from the data, pixels that fluctuated down count more, and every flux is too small. The equations are those of the
/// quasi-likelihood of pixels whose variance grows with their light, and their solution is as good as a likelihood's.
/// @source McCullaghNelder1989 §9; Stetson1987
class FieldSolver {
 public:
  FieldSolver(const PixelPsf& psf, const PsfReach& reach, const FieldPixels& pixels, int sky_cell);

  [[nodiscard]] std::vector<ModelStar>& stars() { return stars_; }
  [[nodiscard]] const std::vector<ModelStar>& stars() const { return stars_; }

  /// Puts stars into the order of rows, gives them stamps, and computes model, weights and residuals.
  void render();
  /// Curvature and slope of every star and pair, at what render() made.
  void assemble();
  /// Solves for the best step by conjugate gradients and takes it.
  /// @param tolerance  of the residual norm.  @returns how many fluxes changed by more than a tenth of their error
  std::size_t step(double tolerance, int most_iterations);

  [[nodiscard]] const PaddedPlane& weight() const { return weight_; }      ///< 1/e-²
  [[nodiscard]] const PaddedPlane& residual() const { return residual_; }  ///< e-, 0 where nothing is usable
  [[nodiscard]] const PaddedPlane& light() const { return light_; }        ///< of the stars, e-
  [[nodiscard]] double sky_at(double x, double y) const;
  [[nodiscard]] const StarStamps& stamps() const { return stamps_; }
  [[nodiscard]] const std::vector<StarTerms>& terms() const { return terms_; }
  [[nodiscard]] const std::vector<PairTerms>& pairs() const { return pairs_; }
  /// Of two stars, first < second; nullptr when they share no pixels.
  [[nodiscard]] const PairTerms* pair(std::size_t first, std::size_t second) const;
  [[nodiscard]] const PixelPsf& psf() const { return psf_; }
  [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }
  [[nodiscard]] const PsfReach& reach() const { return reach_; }
  [[nodiscard]] const FieldPixels& pixels() const { return pixels_; }
  [[nodiscard]] double coupling_reach() const { return coupling_reach_; }

 private:
  void sort_stars();
  void add_light();
  void weigh();
  void assemble_star(std::size_t i, std::span<float> scratch);
  void assemble_sky();
  void multiply(std::span<const double> v, std::span<double> product) const;
  void precondition(std::span<const double> v, std::span<double> result) const;
  void invert_blocks();

  const PixelPsf& psf_;
  const PsfReach& reach_;
  const FieldPixels& pixels_;
  double level_;           // e-, below which a star's wing is left out
  double coupling_reach_;  // px, beyond which two stars hardly share pixels
  std::vector<ModelStar> stars_;
  StarStamps stamps_;
  Neighbours neighbours_;
  std::vector<std::uint32_t> near_;
  PaddedPlane light_;
  PaddedPlane weight_;
  PaddedPlane residual_;
  std::vector<StarTerms> terms_;
  std::vector<PairTerms> pairs_;                // in the order of first, second
  std::vector<std::size_t> first_pair_;         // of each star as the first
  std::vector<std::array<double, 9>> inverse_;  // of the stars' own blocks
  SkySpline sky_;
  std::vector<double> sky_coefficients_;
  std::vector<double> sky_slope_;
  std::vector<double> block_weight_;
  double mean_block_weight_ = 1.0;
  mutable std::vector<double> block_values_;
};

}  // namespace astroid::detail
