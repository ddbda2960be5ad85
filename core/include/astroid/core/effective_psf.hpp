// A PSF as an image shows it: the fraction of a star in a pixel as a smooth function of where the pixel is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

/// Pixel-integrated ("effective") PSF: cubic B-splines on a square grid finer than the pixel, their coefficients
/// polynomials of the star's place in the field.
///
/// With (dx, dy) from the star to a pixel's centre, the pixel's fraction is sum_k phi_k(u, v) sum_ij c_kij
/// B(n dx + half - i) B(n dy + half - j), phi = 1, u, v, u², uv, v², where (u, v) is the place from `field_centre` in
/// units of `field_scale`, held at ±1 beyond. No integral over the pixel is needed: it is in what was measured.
/// @source AndersonKing2000; differs: splines, and polynomials over the field.
struct EffectivePsf {
  int samples_per_pixel = 2;
  int half = 0;   ///< samples from the star to the edge of the grid
  int order = 0;  ///< of the polynomials, 0 … 2
  PixelPosition field_centre{0.0, 0.0};
  PixelPosition field_scale{1.0, 1.0};  ///< px
  std::vector<double> coefficients;     ///< shape (terms(), side(), side())

  [[nodiscard]] int side() const { return 2 * half + 1; }
  [[nodiscard]] std::size_t plane_size() const {
    return static_cast<std::size_t>(side()) * static_cast<std::size_t>(side());
  }
  [[nodiscard]] std::size_t terms() const { return static_cast<std::size_t>((order + 1) * (order + 2) / 2); }
};

/// The four cubic B-splines that are not zero at a distance t in [0, 1) beyond the second of them, and their slopes.
struct CubicWeights {
  double weight[4];
  double slope[4];
};
[[nodiscard]] CubicWeights cubic_weights(double t);

/// Where the pixels around a star lie on the grid of an effective PSF along one axis: for all the same weights.
struct EffectiveAxis {
  int pixel = 0;         ///< nearest to the star
  int first = 0;         ///< index of the first spline of that pixel; one pixel on it is samples_per_pixel more
  CubicWeights weights;  ///< slopes are those with respect to the grid
};
[[nodiscard]] EffectiveAxis effective_axis(const EffectivePsf& psf, double star);

/// The polynomials of the field at a place: 1, u, v, u², uv, v², the first psf.terms() of them.
void field_terms(const EffectivePsf& psf, PixelPosition place, double* phi);

/// Values at the nodes of the grid, of a plane of coefficients (side × side), in place, and back.
void spline_values_of(std::vector<double>& plane, int side);
void spline_coefficients_of(std::vector<double>& plane, int side);

/// @throws InputError when its numbers make no PSF.
std::shared_ptr<const PixelPsf> make_effective_psf(EffectivePsf psf);

/// True for a file that write_effective_psf() made.
bool is_effective_psf(const std::filesystem::path& file);

/// One image of shape (terms, side, side): values at the grid's nodes. Keywords PSFTYPE = 'EFFECTIVE', SUBPIX (samples
/// per pixel), CRPIX1 and CRPIX2 (the star, 1-based), PSFORDER, and FIELDX, FIELDY, FIELDSX, FIELDSY (0-based px).
/// @throws EnvironmentError when it cannot be written.
void write_effective_psf(const std::filesystem::path& file, const EffectivePsf& psf);

/// @throws InputError naming every keyword that is wrong; EnvironmentError when the file cannot be read.
EffectivePsf read_effective_psf(const std::filesystem::path& file);

}  // namespace astroid
