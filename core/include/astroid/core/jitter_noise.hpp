// What pointing jitter does to the flux in an aperture: predictions that simulations are judged by.
#pragma once

#include <span>

#include "astroid/core/units.hpp"

namespace astroid {

/// Relative change of an aperture's flux per pixel of the star's motion, d ln F / dx = sum w dp/dx / sum w p.
double aperture_gradient(std::span<const double> weights, std::span<const double> fractions,
                         std::span<const double> gradient);

/// Relative flux noise, to first order, of independent motions of rms (sx, sy) px with the gradients (gx, gy).
double jitter_noise(double gx, double gy, double sx, double sy);

/// Width of the PSF that the mean exposure sees when it jitters by `rms` much faster than the exposure: the jitter's
/// Gaussian and the PSF's convolve, so the expected flux is exact with this width.
double jittered_sigma(double sigma, double rms);

/// Relative flux noise of independent pixel gain errors of rms `prnu` under motions of rms (sx, sy) px:
/// prnu sqrt(sum (sx dp/dx)^2 + (sy dp/dy)^2); one axis of a Gaussian broader than 0.8 px: prnu s / (sqrt(8 pi)
/// sigma^2).
double prnu_jitter_noise(double prnu, std::span<const double> dpdx, std::span<const double> dpdy, double sx, double sy);

/// Scatter of the flux over positions that share no pixels, from pixel gain errors of rms `prnu`: prnu sqrt(sum p^2).
double prnu_static_noise(double prnu, std::span<const double> fractions);

/// The same from a pattern of rms `rms` with a spatial spectrum f^-exponent: rms share^(1 - exponent / 2), at most rms.
/// An aperture sees the frequencies below that of its own size, which is 1 / share.
/// @param share  sqrt(sum p^2).  @accuracy 20 % (test: FlatField.ScattersFluxesAsPredicted).
double flat_field_static_noise(double rms, double exponent, double share);

/// Times of a series of exposures.
struct Cadence {
  Seconds cycle;          ///< from start to start
  Seconds exposure_time;  ///< <= cycle; 0: instantaneous
  long exposures = 1;
};

/// Rms of the mean over a series of exposures of an Ornstein-Uhlenbeck process, each exposure averaging over its time.
///
/// Exact, from the covariance s^2 e^(-|t|/tau). An hour of red jitter averages far less than 1/sqrt(n): of 144
/// exposures of 25 s with tau = 250 s 0.36 of the rms is left, of white noise 0.083.
/// @param rms  stationary, any unit; tau > 0. @complexity O(exposures). @source UhlenbeckOrnstein1930.
double ou_mean_rms(double rms, Seconds tau, const Cadence& cadence);

/// Covariance of the mean over such a series with that over the same series begun `lag` later, in units of the
/// variance of the process: what cameras that read out one after the other share of it.
///
/// Exact; ou_mean_rms()² at no lag. Exposures may overlap: the covariance of means over T at a distance u is
/// (h(u + T) - 2 h(u) + h(u - T)) tau² / T², h(t) = e^(-|t|/tau) + |t|/tau.
/// @complexity O(exposures). @source UhlenbeckOrnstein1930 (F111).
double ou_mean_covariance(Seconds tau, const Cadence& cadence, Seconds lag);

}  // namespace astroid
