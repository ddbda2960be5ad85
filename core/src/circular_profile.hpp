// Circular point-spread functions as surface brightness against distance, and tables of their exact fluxes.
#pragma once

#include <functional>
#include <string>

#include "astroid/core/psf.hpp"

namespace astroid::detail {

/// Surface brightness of a star of unit flux, normalised on infinite support.
struct CircularProfile {
  std::function<double(double r2)> density;  ///< 1/px² at squared distance r2 (px²)
  double scale = 1.0;                        ///< px: over which it changes; decides the quadrature
  std::string name;
};

/// F54. @throws InputError naming everything that makes the PSF unusable, its wings included.
CircularProfile moffat_profile(double fwhm, double beta, const PsfWings& wings);
/// F55. @throws InputError likewise
CircularProfile airy_profile(double lambda_over_d, double obscuration, const PsfWings& wings);

/// What of a profile is imaged: diffused, and faded out towards the reach (F120) so that light ends in no step, which
/// neither a map of sub-pixels nor a library of phases could hold. 0 beyond the reach.
/// @accuracy  1e-13 of the peak (tests: CircularSpectrum.OfDiffusedLightIsTheProduct,
/// CircularSpectrum.IsTheFourierTransformOfTheFadedLight)
/// @complexity  quick to evaluate, whatever the profile (RadialTable)
CircularProfile as_imaged(const CircularProfile& profile, const PsfWings& wings);

/// Light in a rectangle, px from the star, by composite Gauss-Legendre quadrature.
/// @accuracy  1e-13 of the star's light
double profile_flux(const CircularProfile& profile, PixelPosition lower, PixelPosition upper);

/// Flux of every cell of a square of cells about the star, by Gauss-Legendre quadrature.
///
/// The total is what falls into the square, not 1: 1 minus it is the light beyond.
/// @param samples_per_pixel  even   @param half_width  px, of the square
/// @accuracy  1e-11 of a cell's flux (tests: Moffat.HasTheFluxOfAdaptiveQuadrature,
/// Airy.HasTheFluxOfAdaptiveQuadrature)
PsfTable flux_table(const CircularProfile& profile, int samples_per_pixel, int half_width);

}  // namespace astroid::detail
