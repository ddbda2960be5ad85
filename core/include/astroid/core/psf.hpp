// Point-spread functions as what photometry needs of them: the fraction of a star's flux in each pixel.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/pixel_response.hpp"
#include "astroid/core/units.hpp"

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

  /// Relative error of the light in an aperture, anywhere in the star's image, by the approximation of this renderer (0
  /// if exact); PsfAccuracy says what it is relative to.
  [[nodiscard]] virtual double approximation_error() const = 0;

  /// Where on the detector it may be told from others: one place for a PSF that is the same everywhere.
  [[nodiscard]] virtual std::vector<PixelPosition> places() const { return {{0.0, 0.0}}; }

  [[nodiscard]] virtual std::string description() const = 0;
};

/// What an approximation may do to the light of a star in any square of 2 or 3 px, about the star or in its wings.
///
/// A fainter star's aperture may lie there, so light is judged wherever it falls: by itself, or, where there is little
/// of it, by what the faintest star in question has in its aperture.
struct PsfAccuracy {
  // NOLINTNEXTLINE(google-explicit-constructor): mostly one number
  PsfAccuracy(double of_light, double least = 1e-3) : relative(of_light), least_light(least) {}
  double relative;     ///< error relative to the light in the square
  double least_light;  ///< of the star's flux: less light than this is judged as if it were this much; by default the
                       ///< star is a thousand times as bright as the faintest
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

/// What a PSF with wings leaves out, and what the detector does to it.
struct PsfWings {
  static constexpr int kLongestReach = 90;
  int reach = 30;          ///< px: where light ends, faded out over the last 6 px (F120); 2 .. kLongestReach
  double diffusion = 0.0;  ///< px: rms of the charge diffusion, 0 .. 3
};

/// Moffat's profile, (1 + r²/alpha²)^(-beta), integrated over pixels: exact fluxes at every sub-pixel phase of a
/// library, four-point interpolation in between, with more phases within 8 px than beyond (renderer `prf`).
///
/// Normalised on infinite support: (1 + r²/alpha²)^(1-beta) of the light is farther than r from the star, and what is
/// beyond the reach is left out, not redistributed. So that light ends in no step, which the sub-pixel map could not
/// hold, it fades out over the last 6 px (F120), or over half of a reach below 12 px.
/// @param fwhm      px, 0.2 .. 20; alpha = fwhm / (2 sqrt(2^(1/beta) - 1))
/// @param beta      more than 1, at most 100
/// @param accuracy  allowed to the interpolation; decides the number of phases.
/// @param phases    of the core per axis, or 0 to let `accuracy` decide.
/// @param response  sensitivity within every pixel, folded in as by make_prf_psf()
/// @accuracy  approximation_error(), tested against adaptive quadrature (Moffat.HasTheFluxOfAdaptiveQuadrature)
/// @source Moffat1969, Trujillo2001   @throws InputError naming every unusable parameter
std::shared_ptr<const PixelPsf> make_moffat_psf(double fwhm, double beta, const PsfWings& wings,
                                                const PsfAccuracy& accuracy, int phases = 0,
                                                const PixelResponse& response = {});

/// Diffraction pattern of a round aperture with a round central obscuration, integrated over pixels like
/// make_moffat_psf().
///
/// Normalised on infinite support: about 2 / (pi² (1 - obscuration) r / (lambda/D)) of the light is farther than r from
/// the star; what is beyond the reach is left out.
/// @param lambda_over_d  px, 0.3 .. 20: wavelength over diameter; the first dark ring without obscuration is at 1.2197
///                       of it
/// @param obscuration    diameter of the central obscuration over that of the aperture, 0 to less than 1
/// @source Schroeder2000 §10.2
std::shared_ptr<const PixelPsf> make_airy_psf(double lambda_over_d, double obscuration, const PsfWings& wings,
                                              const PsfAccuracy& accuracy, int phases = 0,
                                              const PixelResponse& response = {});

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

/// The table after its charge has diffused: convolved with a Gaussian of rms `sigma` px, sums kept, and extended by its
/// reach. Samples wider than sigma are divided first, along the spline of make_prf_psf().
/// @accuracy  1e-8 of the flux for tables of at least a sample per sigma (test: Diffusion.AddsItsVariance)
/// @throws InputError when sigma is negative or not finite.
PsfTable diffuse_psf_table(const PsfTable& table, Pixels sigma);

/// Pixel-integrated library over sub-pixel phases with four-point Lagrange interpolation (renderer `prf`).
///
/// The table's flux per sample is kept exactly: its running integral is a tensor cubic spline through the sample edges.
/// @param accuracy  allowed to the interpolation; decides the number of phases. At the border of the table, where light
///                  may end in a step, the error is not judged: a tenth of the step over the square of the phases.
/// @param phases    number of phases per axis, or 0 to let `accuracy` decide.
/// @param response  sensitivity within every pixel, folded in exactly: a fraction is then the light of each cell of the
///                  pixel times the cell's sensitivity, and their sum is 1 on the mean over the star's places only.
std::shared_ptr<const PixelPsf> make_prf_psf(const PsfTable& table, const PsfAccuracy& accuracy, int phases = 0,
                                             const PixelResponse& response = {});

/// A circular Gaussian as a table, its samples holding the exact flux, so fine and so wide that make_prf_psf() of it is
/// the Gaussian within `accuracy` of the star's light.
/// @accuracy  the running integral's spline leaves 4e-3 / (samples per sigma)⁴ of the light in the brightest pixel
///            (test: GaussianTable.IsAsFineAsTheAccuracyNeeds)
/// @param sigma  px, > 0
PsfTable make_gaussian_table(double sigma, double accuracy);

/// A PSF table and the place of the field where it holds.
struct FieldPsfTable {
  PixelPosition position;
  PsfTable table;
};

/// Reads every image of a FITS file as a PSF table (read_psf_table()); its place on the detector, 0-based px, stands in
/// the keywords FIELDX and FIELDY.
/// @throws InputError naming image and keyword; EnvironmentError when the file cannot be read.
std::vector<FieldPsfTable> read_field_psf(const std::string& path);

/// A PSF that varies over the field: tables blended with the weights of a thin-plate spline through their places, so
/// smooth, exact at every table's place, and of sum 1. Beyond the box around the places it stays what it is at the
/// edge.
/// @param diffusion  px, of the charge (diffuse_psf_table()).  @param accuracy, phases  of make_prf_psf().
/// @complexity  as many times make_prf_psf()'s as there are tables
/// @throws InputError when two tables share a place.
std::shared_ptr<const PixelPsf> make_field_psf(std::span<const FieldPsfTable> tables, Pixels diffusion,
                                               const PsfAccuracy& accuracy, int phases = 0,
                                               const PixelResponse& response = {});

}  // namespace astroid
