// How much of the light the optics let through.
#pragma once

#include "astroid/core/mission.hpp"
#include "astroid/core/wcs.hpp"

namespace astroid {

/// Light that the optics pass at a time since the start of the run, relative to what zero point and sky background
/// include: linear from the beginning to the end of life, not below 0.
double throughput_at(const Mission& mission, Seconds time);

/// Its mean over the run.
double mean_throughput(const Mission& mission);

/// Light passed at an angle from the axis relative to the axis, 0 to 1: cos² or 1 - (c1 x² + c2 x⁴ + ...) / 100 with x
/// in degrees.  @source F50
double vignetting_at(const VignettingSettings& settings, Degrees angle);

/// Vignetting of a pixel position; 0 where no direction falls.
double vignetting_at(const VignettingSettings& settings, const SkyProjection& projection, PixelPosition position);

}  // namespace astroid
