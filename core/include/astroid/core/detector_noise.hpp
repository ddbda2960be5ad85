// What a detector makes of the electrons of an exposure, CCD or CMOS: noise of its reads, range of what it delivers.
#pragma once

#include <memory>

#include "astroid/core/inter_pixel_coupling.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/noise.hpp"
#include "astroid/core/ramp.hpp"

namespace astroid {

/// How the pixels of a mission's detector are read; one read for a CCD.
RampNoise ramp_noise(const Mission& mission);

/// Variance of one read of a pixel, e-²: readout and quantisation noise.
double read_variance(const Mission& mission);

/// Background light and dark current of one exposure, and the noise of reading it.
/// @param light  sky and stray light, per pixel; expected_pixel_noise(mission) in sky_brightness.hpp knows it.
PixelNoise expected_pixel_noise(const Mission& mission, ElectronsPerSecond light);

/// Readout noise that the fit of a ramp leaves in a dark pixel, over that of one read; 1 where there is one.
double fitted_readout_factor(const Mission& mission);

/// Bits of the delivered counts: those of the ADC; more for a fitted ramp, which may have saturated after its second
/// read and then stands for as many times the range as there are increments. At most 24, which a float holds exactly,
/// unless the ADC has more.
int delivered_bits(const Mission& mission);

/// Electrons of an exposure from which a pixel is saturated: full well or the end of the ADC's range, at the last read
/// or, for a ramp, at the second, since a fit needs two.
double saturation_electrons(const Mission& mission);

/// Of a CMOS detector.
InterPixelCoupling pixel_coupling(const CmosSettings& cmos);

/// The PSF as images of the mission's detector show it, and as the ground measures it: `psf` itself, or spread by
/// inter-pixel capacitance.
std::shared_ptr<const PixelPsf> imaged_psf(const Mission& mission, std::shared_ptr<const PixelPsf> psf);

/// Rms of the fixed response of the pixels, relative: their sensitivity and, of a CMOS detector, their gain.
double pixel_response_rms(const Mission& mission);

}  // namespace astroid
