// What kind of scene an image shows, which method suits it, and what its noise says about its gain.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "astroid/core/frame.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/photometry/background.hpp"

namespace astroid {

/// What the choice of a method looks at.
struct ImageScene {
  std::size_t stars = 0;    ///< found, or in the catalogue
  double fwhm = 0.0;        ///< px; NaN where nothing tells
  double neighbours = 0.0;  ///< share of the stars with another within three FWHM
  bool psf_given = false;
  bool catalogue = false;
};

struct MethodChoice {
  PhotometryMethod method = PhotometryMethod::kAperture;
  std::string why;  ///< one sentence
};

/// Fits where the PSF is known, but an undersampled sparse scene with a catalogue is measured with a weighted mask,
/// which forgives an error of the PSF's shape within a pixel; circles where it isn't known.
[[nodiscard]] MethodChoice choose_method(const ImageScene& scene);

/// Gain from photon transfer within one image: variance of the background against its level, cell by cell.
struct MeasuredGain {
  double gain = 0.0;   ///< e-/ADU
  double error = 0.0;  ///< from the scatter of the cells about a line
};

/// @returns nothing when the background is too even to tell: the slope is less than five times its error, or there are
/// fewer than nine cells.
/// @source F154; Janesick2001
[[nodiscard]] std::optional<MeasuredGain> measure_gain(const BackgroundMap& background);

}  // namespace astroid
