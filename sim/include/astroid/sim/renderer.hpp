// How stars become light on pixels: which renderer, and what it is made of.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "astroid/core/mission.hpp"
#include "astroid/core/pixel_response.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/sub_pixel.hpp"

namespace astroid {

std::string_view to_string(Renderer renderer);

/// A renderer, never kAuto, and why.
struct RendererChoice {
  Renderer renderer = Renderer::kAnalytic;
  std::string why;
};

/// What the configuration asks for, or what fits: analytic for a Gaussian, prf for any other PSF and where sensitivity
/// within the pixel is the same in all pixels, subpixel where it differs from pixel to pixel.
/// @throws InputError when what is asked for cannot make this PSF or this response.
RendererChoice choose_renderer(const Mission& mission);

/// Whether sensitivity within the pixel changes fluxes by more than the accuracy.
bool has_intra_pixel_response(const Mission& mission);

/// The profile that all pixels share.
PixelResponse common_response(const IntraPixelSettings& settings);

/// What the detector records of a star: the PSF weighted with the common response within the pixel, as the plan's
/// renderer wants it. Mostly `optical` itself.
/// @param optical  of make_psf().  @throws InputError, EnvironmentError for a table
std::shared_ptr<const PixelPsf> make_recorded_psf(const Mission& mission, const PsfAccuracy& accuracy,
                                                  std::shared_ptr<const PixelPsf> optical);

/// The sub-pixel renderer of a mission, for light in the cells of the response if there is one.
/// @param accuracy  of a star's flux, relative; for a Gaussian, which is cheap to make exact, `tight` instead
/// @throws InputError, EnvironmentError
std::shared_ptr<const SubPixelRenderer> make_sub_pixel_renderer(const Mission& mission, double accuracy, double tight);

}  // namespace astroid
