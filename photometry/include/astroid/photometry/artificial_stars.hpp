// How complete a measurement is, and how right: stars of known flux are added to an image and looked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

struct ArtificialStarSettings {
  std::size_t stars = 2000;       ///< in all; as many runs as they need without meeting each other
  double faintest = 0.0;          ///< e-; fluxes are uniform in magnitude from here
  double brightest = 0.0;         ///< e-
  double bin = 0.5;               ///< mag, about, of a bin: a whole number of them
  double spacing = 24.0;          ///< px, least distance of two added stars
  double match = 1.0;             ///< px
  double match_magnitude = 0.75;  ///< a star that comes back farther off than this is lost: another was found there
  std::uint64_t seed = 1;
};

/// Added stars of a range of fluxes.
struct CompletenessBin {
  double brightest = 0.0;  ///< e-
  double faintest = 0.0;   ///< e-
  std::size_t added = 0;
  std::size_t found = 0;
  // NaN where fewer than 5 were found.
  double magnitude_error = std::numeric_limits<double>::quiet_NaN();    ///< median of measured - true, mag
  double magnitude_scatter = std::numeric_limits<double>::quiet_NaN();  ///< robust, mag
  double pull = std::numeric_limits<double>::quiet_NaN();               ///< median of (measured - true) / flux_err
  double pull_width = std::numeric_limits<double>::quiet_NaN();         ///< robust

  [[nodiscard]] double completeness() const;
  /// Binomial, of Laplace's rule: never 0.
  [[nodiscard]] double completeness_error() const;
};

/// Adds stars with their photon noise to region 0 of copies of the frame, calls `measure` with each, and compares.
///
/// Places are one in each square of a grid, anywhere but at its rim, on a different grid in every run; stars of the
/// image itself are where they are, so that a crowd hides what it hides.
/// @returns bins from bright to faint.
/// @throws InputError unless there are stars, and 0 < faintest < brightest.
/// @rng     a stream of its own for each run, addressed by star and pixel  @source F149; Stetson1987
[[nodiscard]] std::vector<CompletenessBin> add_artificial_stars(
    const Frame& frame, const PixelPsf& psf, const ArtificialStarSettings& settings,
    const std::function<std::vector<SourceMeasurement>(const Frame&)>& measure);

/// Flux at which completeness falls below `share` for good, e-, between the middles of bins; NaN where it never does,
/// or always is.
[[nodiscard]] double completeness_limit(std::span<const CompletenessBin> bins, double share);

/// CSV: mag_bright,mag_faint,added,found,completeness,completeness_err,mag_error,mag_scatter,pull,pull_width.
/// @param zero_point  that gives one electron per second  @throws EnvironmentError when the file cannot be written.
void write_completeness(const std::filesystem::path& file, std::span<const CompletenessBin> bins, Magnitude zero_point,
                        Seconds exposure);

}  // namespace astroid
