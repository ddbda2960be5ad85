// Point-spread functions as what photometry needs of them: the fraction of a star's flux in each pixel.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/pixel_response.hpp"

namespace astroid {

/// A star on its way to an image.
struct StarLight {
  PixelPosition centre;
  double electrons = 0.0;
  double half_width = 0.0;    ///< of its stamp, px (stamp_box())
  MotionCovariance motion{};  ///< of its position about the centre, px²
  bool broadened = false;     ///< whether the motion counts
};

/// A point-spread function integrated over pixels. Implementations are immutable and may be shared by threads.
class PixelPsf {
 public:
  PixelPsf() = default;
  PixelPsf(const PixelPsf&) = delete;
  PixelPsf& operator=(const PixelPsf&) = delete;
  PixelPsf(PixelPsf&&) = delete;
  PixelPsf& operator=(PixelPsf&&) = delete;
  virtual ~PixelPsf() = default;

  /// Fractions of the flux of a star at `centre` in the pixels of `box`, row by row.
  ///
  /// Normalised on infinite support: the fractions of a box are never renormalised. The value of a pixel depends
  /// only on the star's position and the pixel, not on the box, bit for bit. A position that is not finite gives NaN.
  /// @param fractions  [out] shape (box.ny, box.nx), unit 1.
  virtual void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const = 0;

  /// Derivatives of the same fractions with respect to the star's position (not the pixel's).
  ///
  /// @param dpdx, dpdy  [out] shape (box.ny, box.nx), unit 1/px.
  virtual void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                                  std::span<double> dpdy) const = 0;

  /// The fractions of a star that moves about `centre` while it is exposed, to second order in the motion.
  ///
  /// Exact mean for a Gaussian PSF and Gaussian motion along the axes (sigma -> sqrt(sigma² + s²)); in general the
  /// three-point Gauss-Hermite rule along the principal axes of the motion.
  /// @param motion     covariance of the position about its mean, px².
  /// @param fractions  [out] shape (box.ny, box.nx).  @param scratch  resized as needed.
  /// @accuracy  O(motion² / sigma⁴) relative (test: Broadening.IsTheMeanOfMovedStampsToSecondOrder).  @source F26
  virtual void integrate_broadened(PixelPosition centre, const MotionCovariance& motion, Rectangle box,
                                   std::span<double> fractions, std::vector<double>& scratch) const;

  /// Adds a star's light to the pixels of its stamp: electrons times the fractions of integrate(), or of
  /// integrate_broadened().
  ///
  /// What a pixel gains depends on the star and the pixel only, not on the image, bit for bit. A star that is nowhere
  /// (a position that is not finite) adds nothing.
  /// @param image    whole rows of an image, contiguous: area().nx == stride().  @param scratch  resized as needed.
  /// @accuracy  of integrate(), and 1e-13 of the star's light (tests: GaussianProfiles.AreTheIntegrals,
  ///            AddStar.AddsTheFractionsOfIntegrate)  @complexity (bench: BM_AddStar)
  virtual void add_star(const StarLight& star, const ImageView<double, unit::ExpectedElectrons>& image,
                        std::vector<double>& scratch) const;

  /// Half-width in pixels of the square stamp around the star outside of which less than `lost` of its flux falls,
  /// for any sub-pixel position.  @param lost  in (0, 1)
  [[nodiscard]] virtual double stamp_half_width(double lost) const = 0;

  /// Upper bound of the relative error of an aperture's flux due to the approximation of this renderer (0 if exact).
  [[nodiscard]] virtual double approximation_error() const = 0;

  [[nodiscard]] virtual std::string description() const = 0;
};

/// The pixels of a stamp of half-width r around a star: every pixel whose area touches the square, edges included.
/// Empty for a position that is not finite or farther than 1e9 px from the origin.
[[nodiscard]] Rectangle stamp_box(PixelPosition centre, double half_width);

/// Circular Gaussian, integrated exactly as a product of two differences of erf (renderer `analytic`).
///
/// @param sigma  px, >= 0; below 1e-8 px the star is a point: its pixel gets all, an edge half, a corner a quarter.
/// @throws InputError if sigma is negative or not finite.
/// @accuracy     1e-12 relative in every pixel for sigma <= 100 px, also far in the wing, where erfc is used on the far
///               side (test: GaussianPsf.KeepsItsRelativeAccuracyFarFromTheStar). Less than 1e-150 along one axis is 0.
/// @complexity   2 (n + 1) tails and n^2 products for n x n pixels, no allocation (bench: BM_GaussianStamp)
std::shared_ptr<const PixelPsf> make_gaussian_psf(double sigma);

/// A PSF given as a table: surface brightness on a grid finer than the pixel.
struct PsfTable {
  Image<double, unit::Relative> samples;  ///< any normalisation; must be finite and have a positive sum
  double samples_per_pixel = 1.0;
  double centre_x = 0.0;  ///< 0-based sample coordinates of the PSF's origin
  double centre_y = 0.0;
};

/// Reads a PSF image: first image HDU; samples per pixel from keyword SUBPIX (or PIXSAMP, or CDELT1 in px), origin from
/// CRPIX1/2 (1-based) or the geometric centre of the image.
/// @throws InputError naming the file and keyword; EnvironmentError when the file cannot be read.
PsfTable read_psf_table(const std::string& path);

/// Pixel-integrated library over sub-pixel phases with four-point Lagrange interpolation (renderer `prf`).
///
/// The table's flux per sample is kept exactly: its running integral is a tensor cubic spline through the sample edges.
/// @param accuracy  relative flux error allowed to the interpolation; decides the number of phases.
/// @param phases    number of phases per axis, or 0 to let `accuracy` decide.
/// @param response  sensitivity within every pixel, folded in exactly: a fraction is then the light of each cell of the
///                  pixel times the cell's sensitivity, and their sum is 1 on the mean over the star's places only.
std::shared_ptr<const PixelPsf> make_prf_psf(const PsfTable& table, double accuracy, int phases = 0,
                                             const PixelResponse& response = {});

/// A circular Gaussian as a table, its samples holding the exact flux, so fine and so wide that make_prf_psf() of it is
/// the Gaussian within `accuracy` of the star's light.
/// @accuracy  the running integral's spline leaves 4e-3 / (samples per sigma)⁴ of the light in the brightest pixel
///            (test: GaussianTable.IsAsFineAsTheAccuracyNeeds)
/// @param sigma  px, > 0
PsfTable make_gaussian_table(double sigma, double accuracy);

}  // namespace astroid
