// The optics of a mission, made from its configuration.
#pragma once

#include <memory>

#include "astroid/core/distortion.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/wcs.hpp"

namespace astroid {

/// The distortion of a mission; null where it has none. @throws InputError, EnvironmentError for a SIP file
std::shared_ptr<const Distortion> make_distortion(const Mission& mission);

/// Where a mission's camera points, and its distortion.
CameraPointing make_pointing(const Mission& mission);

/// The projection of a mission onto its detector.
SkyProjection make_projection(const Mission& mission);

/// The PSF of a mission. @throws InputError, EnvironmentError for a table
/// @param accuracy  of a PSF that needs a library
/// @param response  sensitivity within every pixel, folded in; a Gaussian has none (make_recorded_psf())
std::shared_ptr<const PixelPsf> make_psf(const Mission& mission, const PsfAccuracy& accuracy,
                                         const PixelResponse& response = {});

/// How far from a star its PSF has light that counts, px: found without making a library.
double psf_reach(const Mission& mission, double lost);

}  // namespace astroid
