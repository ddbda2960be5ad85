// Photometry of whole images without a catalogue: stars are found, and all fitted at once with the sky.
#pragma once

#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/photometry/background.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

struct FieldPhotometrySettings {
  double threshold = 5.0;  ///< least flux of a star in units of its error
  int rounds = 10;         ///< of detection at most
  MeshSettings mesh;       ///< of the first estimate of the sky; its cell is that of the fitted sky too
  Magnitude zero_point{0.0};
  double psf_error = 0.0;  ///< sigma of what the PSF's error does to a flux, relative; it is in flux_err
};

/// Finds the stars of region 0 of a frame and fits positions, fluxes and sky together.
///
/// Stars are looked for in the image filtered by the PSF, subtracted, and looked for again in what is left, until
/// nothing new is significant. Flux errors are those of the fit with all neighbours free, and of stars too faint or
/// too near to another to be detected, whose effect is measured in the residuals and follows from the counts.
/// Pixels that are flagged or not finite have no weight. Sources are in the order of bands of rows.
/// @param frame  region 0 from pixel (0, 0), with gain, bias and readout noise in its header; without readout noise,
/// the noise is measured.
/// @param sky    coordinates of the image, or nullptr.
/// @throws InputError unless the threshold and the number of rounds are positive.
/// @source F133, F134; Stetson1987; differs: one system of equations for the field, solved by conjugate gradients
std::vector<SourceMeasurement> measure_field(const Frame& frame, const SkyProjection* sky, const PixelPsf& psf,
                                             const FieldPhotometrySettings& settings);

}  // namespace astroid
