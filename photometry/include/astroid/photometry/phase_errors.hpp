// How wrong a PSF is, by where within a pixel stars are.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

/// Stars whose place within their pixel is in one cell.
struct PhaseError {
  double phase_x = 0.0;  ///< px from the pixel's centre, -0.5 … 0.5, of the middle of the cell
  double phase_y = 0.0;
  std::size_t stars = 0;
  double residual = 0.0;        ///< what is left in their brightest pixels, relative to their light there; NaN for none
  double residual_error = 0.0;  ///< from photon and background noise
};

/// Of `cells` × `cells` cells, row by row from (-0.5, -0.5). Stars that are flagged, or fainter than 50 sigma, do not
/// count. A PSF that is sampled wrongly shows a pattern here that its chi² hides.
/// @param residual  of residual_image() with the same PSF  @param background_rms  ADU, of a pixel
/// @source F146; AndersonKing2000 §4
[[nodiscard]] std::vector<PhaseError> phase_errors(const Image<float, unit::Adu>& residual, Gain gain,
                                                   double background_rms, std::span<const SourceMeasurement> sources,
                                                   const PixelPsf& psf, std::size_t cells = 5);

/// CSV: phase_x,phase_y,stars,residual,residual_err.
/// @throws EnvironmentError when the file cannot be written.
void write_phase_errors(const std::filesystem::path& file, std::span<const PhaseError> errors);

}  // namespace astroid
