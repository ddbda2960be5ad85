// Point-spread functions in Fourier space: what a renderer by convolution needs of them.
#pragma once

#include <complex>
#include <memory>
#include <span>
#include <string>

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

}  // namespace astroid
