// Aperture photometry of whole images without a catalogue: stars are found, and each is measured in a circle.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/photometry/detection.hpp"
#include "astroid/photometry/growth.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

struct FoundStarsSettings {
  DetectionSettings detection;
  /// Of the circles and what is under them; its method is that of apertures. Its map is used where it has one.
  ImagePhotometrySettings measure;
  std::optional<Pixels> radius;  ///< of the circles; nothing: 1.2 FWHM, in a crowd 0.8, and at least 1.5 px
  std::optional<Pixels>
      correct_to;       ///< radius of the aperture correction; nothing: 4 FWHM where the radius is ours, else none
  bool correct = true;  ///< false: fluxes are those in the circles
};

/// Share of the places that have another within `distance`; 0 for no places.
[[nodiscard]] double share_with_neighbours(std::span<const PixelPosition> places, double distance);

/// Above this share of stars with another within three FWHM, a field is a crowd.
inline constexpr double kCrowdedShare = 0.3;
inline constexpr double kCrowdedDistance = 3.0;  ///< FWHM

struct FoundStars {
  std::vector<SourceMeasurement> sources;
  double neighbours = 0.0;  ///< share of the stars with another within kCrowdedDistance
  Detection detection;
  double radius = 0.0;               ///< px, of the circles
  double reference = 0.0;            ///< px, radius that fluxes were corrected to; 0: they were not
  double correction = 1.0;           ///< factor that fluxes were multiplied with
  double correction_error = 0.0;     ///< of the factor, common to all stars and not in their errors
  std::size_t correction_stars = 0;  ///< that it was measured with
};

/// Finds the stars of region 0 of a frame and measures each in a circle around it.
///
/// Neighbours' light in a circle is not taken out; `crowding` says how much of what is known of them it holds.
/// @throws InputError as detect_stars(), measure_image() and measure_growth().
/// @complexity O(pixels + stars): 1024² px in 30 ms (tests/bench/peers.py)
[[nodiscard]] FoundStars measure_found_stars(const Frame& frame, const SkyProjection* sky,
                                             const FoundStarsSettings& settings);

}  // namespace astroid
