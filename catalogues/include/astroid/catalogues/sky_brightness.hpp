// Light of the sky between the stars: zodiacal light by direction and season, and stars that no catalogue resolves.
#pragma once

#include "astroid/core/geometry.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/noise.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// Surface brightness in S10: solar stars of V = 10 per square degree.
struct S10 {
  double value = 0.0;
};

/// Zodiacal light seen from the Earth's orbit, at 500 nm.
///
/// Bilinear in the logarithm of a table by ecliptic latitude and longitude from the Sun. About 10 % by the table
/// itself; the dust cloud's own tilt and the seasons' 2 % of distance are not in it.
/// @param from_sun  ecliptic longitude from the Sun's, any sign.  @param latitude  ecliptic
/// @throws InputError nearer to the Sun than the table goes, about 15 deg.
/// @source Leinert1998 Table 17 (1.28e-8 W m^-2 sr^-1 um^-1 are one S10)
S10 zodiacal_light(Degrees from_sun, Degrees latitude);
/// The same by direction and time. @param mjd  TDB
S10 zodiacal_light(SkyPosition direction, double mjd);

/// Stars fainter than those that surveys to I = 16 or so resolve, by galactic coordinates:
/// I = 18.973 + 8.833 |b|/40 deg + 4.007 (|l|/180 deg)^0.805 mag per square arcsec, and V - I = 0.70 as of the Sun.
/// A fit; 0.5 mag at its best, and an extrapolation above |b| = 40 deg, where it is negligible.
/// @source Winn2013
S10 unresolved_starlight(SkyPosition direction);

/// Detected electrons per second of one pixel from one S10: a solar star's (B-V 0.65, 5778 K), in the zero point's
/// passband, times the solid angle of the pixel at the axis.
/// @throws InputError where V can't be converted to the zero point's passband.
ElectronsPerSecond rate_of_one_s10(const Mission& mission);

/// The sky of a mission in a direction at a time: constant, or zodiacal and unresolved stars; without stray light.
/// @param rate  of rate_of_one_s10(), not used where the sky is constant.  @param time  since the start of the run
ElectronsPerSecond sky_rate(const Mission& mission, ElectronsPerSecond rate, SkyPosition direction, Seconds time);

/// What light from nowhere in the catalogue gives on average: the sky on the axis in the middle of the run, and stray
/// light, times the mean throughput of the optics.
ElectronsPerSecond mean_background_rate(const Mission& mission);

/// Background and dark current of one exposure with that light, and the noise of reading it.
PixelNoise expected_pixel_noise(const Mission& mission);

}  // namespace astroid
