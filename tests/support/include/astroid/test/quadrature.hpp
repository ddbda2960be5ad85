// Slow and trustworthy integrals: the oracle of everything that integrates over pixels.
#pragma once

#include <functional>

#include "astroid/core/geometry.hpp"

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

}  // namespace astroid::test
