// Closed forms of a Gaussian PSF in simple apertures: oracles of photometry and of contamination.
#pragma once

namespace astroid {

/// Fraction of a circular Gaussian inside a circle whose centre is `distance` away from the Gaussian's.
///
/// f = e^-t sum_n t^n/n! [1 - e^-s sum_{k<=n} s^k/k!], s = R^2 / 2 sigma^2, t = d^2 / 2 sigma^2; equals one minus
/// Marcum's Q_1(d/sigma, R/sigma). Each bracket is summed from its own tail, so tiny fractions keep their digits.
/// @param sigma > 0, radius >= 0, distance >= 0, all in the same unit.
/// @accuracy 1e-12 relative. @complexity O(s + t). @source BiserMillman1965.
double gaussian_in_circle(double sigma, double radius, double distance);

/// Fraction of a Gaussian centred at `offset` along one axis within [-half_width, half_width].
double gaussian_in_interval(double sigma, double half_width, double offset);

/// Derivative of the logarithm of gaussian_in_interval() with respect to the offset, 1/px: the relative change of a
/// square aperture's flux per pixel of motion along that axis.
double gaussian_interval_gradient(double sigma, double half_width, double offset);

/// The circular aperture with the best signal to noise for a Gaussian whose noise is all background.
struct OptimalCircularAperture {
  double radius_sigma;  ///< radius / sigma, 1.5852010
  double radius_fwhm;   ///< radius / FWHM, 0.6731729
  double enclosed;      ///< fraction of the flux, 0.7153319
  double snr_ratio;     ///< signal to noise relative to a PSF fit's, 0.9025125
};

/// Solves e^x = 1 + 2 x for x = r^2 / 2 sigma^2, where (1 - e^-x) / sqrt(x) is largest.
OptimalCircularAperture optimal_circular_aperture();

}  // namespace astroid
