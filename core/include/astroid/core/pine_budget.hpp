// The analytic noise budget of the PLATO mission (PINE): random and systematic terms against magnitude.
#pragma once

#include "astroid/core/units.hpp"

namespace astroid {

/// Parameters of the budget. It has no mask geometry: pixels of the mask and the flux of the brightest are inputs.
/// Defaults: Boerner2024 as implemented by Boettner2024, coarse pointing mode, end of life.
struct PineParameters {
  double mask_electrons = 177100.0;  ///< e- in the mask per exposure at `reference`
  double peak_electrons = 47400.0;   ///< e- in the brightest pixel per exposure at `reference`
  Magnitude reference{11.0};         ///< V magnitude that the two belong to
  double mask_pixels = 9.5;
  double exposures = 144.0;  ///< averaged, an hour of 25 s
  Seconds exposure_time{21.0};
  Seconds transfer_time{4.0};            ///< frame transfer, during which columns smear
  double ccd_readout_noise = 44.3;       ///< e- rms
  double fee_readout_noise = 37.0;       ///< e- rms, front-end electronics
  ElectronsPerSecond sky{60.0};          ///< per pixel
  ElectronsPerSecond stray_light{64.0};  ///< per pixel
  double contaminants = 0.01;            ///< of the flux in the brightest pixel
  ElectronsPerSecond smearing{45.0};     ///< per pixel while charge is transferred
  double peak_fraction = 0.27;           ///< flux of the brightest pixel relative to the mask's
  double jitter_density = 0.54;          ///< ppm per sqrt(uHz)
  double jitter_bandwidth = 278.0;       ///< uHz, one per hour
  double breathing = 20.0;               ///< ppm per exposure and camera: the PSF changes with temperature
  double offset_stability = 0.25;        ///< e- of electronics offset per exposure: 1 ADU/K * 25 e-/ADU * 0.01 K
  double offset_independence = 0.66;     ///< share of it that differs between cameras and exposures
};

/// Terms of the budget, all relative to the star's flux, of the mean over `exposures` and all cameras.
struct PineBudget {
  Ppm photon, ccd_readout, fee_readout, other_photons, smearing;  ///< random
  Ppm jitter, breathing, offset;                                  ///< systematic; jitter does not average over cameras
  Ppm random;             ///< quadratic sum of the random terms without photon noise
  Ppm systematic;         ///< quadratic sum of the systematic terms
  Ppm photon_and_random;  ///< what the requirement of 50 ppm in one hour at V = 11 with 24 cameras is about
  Ppm total;
};

/// @param v        V magnitude of the star; valid from 8.5, where pixels do not saturate.
/// @param cameras  that observe it, N >= 1.
/// @source Boerner2024; formulae as in Boettner2024.
PineBudget pine_budget(Magnitude v, double cameras, const PineParameters& parameters = {});

}  // namespace astroid
