// Magnitudes, fluxes, their errors and contamination ratios.
#pragma once

#include <optional>

#include "astroid/core/units.hpp"

namespace astroid {

/// 2.5 / ln 10: a small relative flux error in magnitudes (Pogson).
inline constexpr double kPogson = 1.0857362047581295691;

/// Flux of a star relative to one that is `difference` magnitudes brighter: 10^(-0.4 difference).
///
/// @accuracy 4 ulp for |difference| <= 120 (test: FluxRatio.IsExactToFourUlp); the exponent is carried in two doubles.
/// NaN gives NaN; 0 or inf beyond the range of a double.
double flux_ratio(DeltaMag difference);

/// Detected electrons per second of a star, 10^(-0.4 (m - zp)), zp being the magnitude of one electron per second.
///
/// @throws InputError when the magnitude is NaN or so bright that the rate is not finite. +inf gives 0.
/// @accuracy 4 ulp for m in [-30, 40]
ElectronsPerSecond electron_rate(Magnitude magnitude, Magnitude zero_point);

/// Inverse of electron_rate(). No value for a rate that is not positive and finite: flag it, never drop it silently.
std::optional<Magnitude> magnitude_of(ElectronsPerSecond rate, Magnitude zero_point);

/// What turns photons into detected electrons.
struct Throughput {
  double photon_flux = 0.0;  ///< of magnitude zero, photons s^-1 m^-2 nm^-1
  double bandwidth = 0.0;    ///< nm
  double area = 0.0;         ///< m^2
  double transmission = 1.0;
  double quantum_efficiency = 1.0;
};

/// Magnitude that gives one detected electron per second. @throws InputError unless the product is positive and finite.
Magnitude zero_point(const Throughput& throughput);

/// First-order error of a magnitude. @valid signal to noise >= 5. @source Pogson1856.
DeltaMag magnitude_error(double signal_to_noise);

/// Exact one-sigma interval of a magnitude: `bright` < 0 < `faint`; `faint` is infinite for signal to noise <= 1.
struct MagnitudeInterval {
  DeltaMag bright, faint;
};
MagnitudeInterval magnitude_interval(double signal_to_noise);

/// How much fainter the mean of magnitudes is than the magnitude of the mean, for Poisson counts: 1.0857 / (2 mean).
/// So never average magnitudes. @valid mean >> 1
DeltaMag mean_magnitude_bias(double mean_electrons);

/// Inverse hyperbolic sine magnitude: finite and monotone for any flux, the usual magnitude for f >> b f0.
///
/// m = -(2.5 / ln 10) [asinh(f / (2 b f0)) + ln b].
/// @param relative_flux  f / f0, f0 being the flux of magnitude zero. @param softening  b > 0. @source Lupton1999.
Magnitude asinh_magnitude(double relative_flux, double softening);

/// Its error: (2.5 / ln 10) sigma / (2 b) / sqrt(1 + (f / 2b)^2), fluxes relative to f0.
DeltaMag asinh_magnitude_error(double relative_flux, double relative_error, double softening);

/// Flux of contaminants over the target's, from their share of the total flux: s / (1 - s).
double contaminant_ratio(double spr_total);
/// Share of contaminants in the total flux, from their ratio c to the target: c / (1 + c).
double spr_from_ratio(double contaminant_over_target);
/// CROWDSAP: the target's share of the flux in the aperture, sky removed.
double crowdsap(double spr_total);
/// How much brighter a target looks with contaminants of this ratio to it: -2.5 log10(1 + c), negative.
DeltaMag contamination_shift(double contaminant_over_target);

}  // namespace astroid
