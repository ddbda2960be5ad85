#include "effects/intra_pixel_response.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/sim/renderer.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed IntraPixelResponse::is_needed(const SceneSummary& scene) const {
  const IntraPixelSettings& s = scene.mission->psf.intra_pixel;
  const double depth = common_response(s).depth();
  if (depth == 0.0 && s.flat == 0.0) return {false, "sensitivity is the same all over a pixel", 0.0, 0.0};
  // No flux changes by more than its brightest or darkest cell; what motion makes of that is below it.
  const double largest = std::max(depth, s.flat);
  const double flux = scene.brightest_target_electrons;
  const double moved = largest * scene.psf.gradient * scene.attitude_rms_px;
  const double variance = flux > 0.0 ? moved * moved / scene.relative_variance_in_bin(flux) : 0.0;
  const std::string what =
      s.flat > 0.0 ? fmt::format(
                         "cells of 1/{} px differ by up to {:.3g} % from the pixel's mean and by {:.3g} % rms from "
                         "pixel to pixel",
                         s.cells, 100.0 * depth, 100.0 * s.flat)
                   : fmt::format("cells of 1/{} px differ by up to {:.3g} % from the pixel's mean, alike in all pixels",
                                 s.cells, 100.0 * depth);
  return {has_intra_pixel_response(*scene.mission),
          fmt::format("{}; the accuracy asked for is {:.3g} ppm", what, 1e6 * scene.accuracy), largest * flux,
          variance};
}

void IntraPixelResponse::prepare(CameraState& camera, const PrepareContext& context) const {
  const IntraPixelSettings& s = context.scene.mission().psf.intra_pixel;
  camera.intra_pixel = IntraPixelState{common_response(s), s.flat, context.stream};
}

void IntraPixelResponse::apply(ExposureState& /*state*/, const EffectContext& /*context*/,
                               const Strip& /*strip*/) const {}

}  // namespace astroid
