// What the options of `astroid photometry` mean.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "commands/commands.hpp"

namespace astroid::commands {

/// Whether --psf asks for the PSF that the image shows, or names a file.
bool is_measured(const std::string& psf);
bool names_a_file(const std::string& psf);

/// gaussian:SIGMA_PX or a FITS file; nothing without --psf, or where the image is to tell it.
std::shared_ptr<const PixelPsf> read_psf(const std::string& text);

void set_background(const std::string& text, bool blind, ImagePhotometrySettings& settings);

/// Positions of any catalogue; magnitudes are not needed.
std::vector<SourceRequest> read_requests(const std::string& file);

/// FILE for one image; FILE_IMAGE for each of several.
std::filesystem::path output_for(std::size_t images, const std::string& file, const std::string& image);

PhotometryMethod method_of(const std::string& name);
std::string name_of(PhotometryMethod method);

/// @throws InputError with all options that contradict each other.
void check_options(const PhotometryOptions& options);

}  // namespace astroid::commands
