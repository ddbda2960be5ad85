// Point-spread functions in Fourier space: what a renderer by convolution needs of them.
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

/// The Fourier transform of a PSF of unit flux, H(k) = integral of h(r) e^(-2 pi i k.r), k in cycles/px.
/// Implementations are immutable and may be shared by threads.
class PsfSpectrum {
 public:
  PsfSpectrum() = default;
  PsfSpectrum(const PsfSpectrum&) = delete;
  PsfSpectrum& operator=(const PsfSpectrum&) = delete;
  PsfSpectrum(PsfSpectrum&&) = delete;
  PsfSpectrum& operator=(PsfSpectrum&&) = delete;
  virtual ~PsfSpectrum() = default;

  /// H on a grid of frequencies, one row for each ky.  @param values  [out] shape (ky.size(), kx.size())
  virtual void sample(std::span<const double> kx, std::span<const double> ky,
                      std::span<std::complex<double>> values) const = 0;

  /// Half-width of the square around the star outside of which less than `lost` of its flux falls, px.
  [[nodiscard]] virtual double reach(double lost) const = 0;

  /// What leaving out all frequencies with |kx| > band or |ky| > band may change of the flux in a square of 1 to 5 px,
  /// anywhere, relative to the star's flux.
  [[nodiscard]] virtual double error_beyond(double band) const = 0;

  [[nodiscard]] virtual std::string description() const = 0;
};

/// Circular Gaussian: H = e^(-2 pi² sigma² k²).
///
/// error_beyond() is a bound: (2/pi) E1(2 pi² sigma² band²), to first order (F102). @throws InputError unless sigma is
/// positive and finite.
std::shared_ptr<const PsfSpectrum> make_gaussian_spectrum(double sigma);

/// A PSF table with its flux per sample kept, exactly what make_prf_psf() interpolates: the Fourier transform of the
/// quadratic spline that its surface brightness is.
///
/// error_beyond() is measured: the largest difference to the exact flux, at 64 sub-pixel phases, in squares about the
/// star and at the borders of the table, where light may end in a step.
/// @accuracy  1e-13 (test: PsfSpectrum.OfATableIsTheFourierTransformOfItsSurfaceBrightness)
/// @complexity  sample(): n_kx n_x n_y + n_kx n_ky n_y complex products for a table of n_x by n_y samples
std::shared_ptr<const PsfSpectrum> make_table_spectrum(const PsfTable& table);

/// Moffat's profile faded out towards the reach of its wings (F120), as make_moffat_psf() has it, charge diffusion
/// included: its cosine transform by Gauss-Legendre quadrature as fine as the frequencies ask for.
///
/// error_beyond() is measured as for a table.
/// @accuracy  1e-12 (tests: CircularSpectrum.OfAMoffatProfileIsABesselFunction,
///            CircularSpectrum.IsTheFourierTransformOfTheFadedLight, CircularSpectrum.OfDiffusedLightIsTheProduct)
/// @complexity  sample(): n_kx n² + n_kx n_ky n products, n = 4 reach × (largest k)
/// @throws InputError as make_moffat_psf()
std::shared_ptr<const PsfSpectrum> make_moffat_spectrum(double fwhm, double beta, const PsfWings& wings);

/// The same for the diffraction pattern of make_airy_psf(). Without the fade it would end at 1 / (lambda/D).
std::shared_ptr<const PsfSpectrum> make_airy_spectrum(double lambda_over_d, double obscuration, const PsfWings& wings);

/// A PSF that varies over the field, in Fourier space: the light of a star is a sum over members with weights that
/// belong to its place.
struct FieldSpectrum {
  std::vector<std::shared_ptr<const PsfSpectrum>> members;
  /// Weights of the members at a place; their sum is 1.
  std::function<void(PixelPosition, std::span<double>)> weights;
  double amplification = 1.0;  ///< largest sum of the weights' absolute values: what errors of the members become
};

/// The PSF that make_field_psf() makes: every star has exactly the blend of its own place.
/// @throws InputError as make_field_psf()
FieldSpectrum make_field_spectrum(std::span<const FieldPsfTable> tables, Pixels diffusion);

}  // namespace astroid
