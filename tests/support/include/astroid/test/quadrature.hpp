// Slow and trustworthy integrals: the oracle of everything that integrates over pixels.
#pragma once

#include <functional>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/pixel_response.hpp"
#include "astroid/core/psf.hpp"

namespace astroid::test {

/// Adaptive Gauss-Kronrod (7, 15) integral in 80-bit arithmetic.
/// @param relative  error aimed at, relative to the integral of |f|
long double integrate(const std::function<long double(long double)>& f, long double from, long double to,
                      long double relative);

/// Surface brightness at (dx, dy) px from the star, unit 1/px^2.
using Density = std::function<long double(long double dx, long double dy)>;

/// What a star at `star` leaves in pixel (x, y), by nested adaptive quadrature.
long double integrate_pixel(const Density& density, PixelPosition star, int x, int y, long double relative);

/// Circular Gaussian of unit flux.
Density gaussian_density(long double sigma);
/// F54, of unit flux on infinite support.
Density moffat_density(long double fwhm, long double beta);
/// F55, likewise.
Density airy_density(long double lambda_over_d, long double obscuration);

/// An integral and how well it is known.
struct Integral {
  long double value = 0.0L;
  long double error = 0.0L;  ///< sum over the panels of the difference of the two rules: far above the true error,
                             ///< since the better one is used
  Integral& operator+=(const Integral& other) {
    value += other.value;
    error += other.error;
    return *this;
  }
};

/// First the 7-point Kronrod rule about 3 Gauss points; where that isn't enough, the larger rule, refined until each
/// panel's difference is below its share of `absolute`, or below 1e-18 of its own integral of |f|, which is rounding.
Integral integrate_absolute(const std::function<long double(long double)>& f, long double from, long double to,
                            long double absolute);

/// A PSF as a continuous function of the place: what renderers are measured against.
struct SurfaceBrightness {
  Density density;
  std::vector<long double> x_breaks;  ///< px from the star, rising: where a derivative of the density jumps
  std::vector<long double> y_breaks;
};

/// A PSF given by its formula, smooth everywhere.
SurfaceBrightness smooth_brightness(Density density);
/// The same faded out towards `reach` px from the star (F120), and nothing beyond.
SurfaceBrightness faded_brightness(Density density, long double reach);
/// What a PSF table means: its running integral, known at the edges of the samples, is a natural cubic spline along
/// both axes, and the surface brightness is its mixed derivative, 0 outside the table. Written down again from that
/// definition in 80-bit arithmetic, by second derivatives instead of B-splines.
SurfaceBrightness table_brightness(const PsfTable& table);

/// A rectangle of the detector in px.
struct Area {
  long double x0, x1, y0, y1;
};
/// What pixels cover, edges included.
Area area_of(const Rectangle& pixels);

/// Light of a star at `star` in an area, by nested adaptive quadrature between the breaks.
/// @param absolute  error aimed at, relative to the star's light; the outcome states its own
Integral integrate_area(const SurfaceBrightness& brightness, PixelPosition star, const Area& area,
                        long double absolute);
/// The same in pixel (x, y), weighted with the pixel's response.
Integral integrate_response(const SurfaceBrightness& brightness, const PixelResponse& response, PixelPosition star,
                            int x, int y, long double absolute);

}  // namespace astroid::test
