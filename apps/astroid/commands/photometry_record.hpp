// How the fluxes of one image were measured, kept beside them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid::commands {

struct PhotometryRecord {
  std::string image;
  std::string method;
  std::string why;                                           ///< one sentence
  double gain = 0.0;                                         ///< e-/ADU
  double readout_noise = 0.0;                                ///< e-; 0: that of the background stands for it
  double bias = 0.0;                                         ///< ADU
  double background = 0.0;                                   ///< ADU, median of the mesh
  double background_rms = 0.0;                               ///< ADU, of a pixel
  double fwhm = std::numeric_limits<double>::quiet_NaN();    ///< px, measured in the image
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< px, of circles around stars that were found
  std::size_t sources = 0;
  std::size_t measured = 0;
  std::size_t flagged = 0;
  double seconds_reading = 0.0;    ///< of the image
  double seconds_measuring = 0.0;  ///< background, detection and fluxes
  std::vector<std::string> notes;
};

/// Writes the table, as FITS if the name ends in .fits or .fit, else as CSV with the record in `output`.json beside it.
void write_table(const std::filesystem::path& output, std::span<const SourceMeasurement> sources,
                 const PhotometryRecord& record);

void write_residual(const std::filesystem::path& file, const Image<float, unit::Adu>& residual,
                    const PhotometryRecord& record);

}  // namespace astroid::commands
