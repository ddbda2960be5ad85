// Synthetic star fields: from nothing, or as the faint stars that a catalogue lacks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "astroid/catalogues/sky_region.hpp"
#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// Star counts: the number of stars brighter than m grows as 10^(slope m).
inline constexpr double kDefaultCountSlope = 0.35;  ///< between Euclid's 0.6 and the 0.2 of V = 20 (Cox 2000, ch. 19)

struct FieldRequest {
  SkyRegion region;
  std::string passband = "V";
  Magnitude bright{6.0};  ///< no star is brighter
  Magnitude faint{15.0};  ///< no star is fainter
  double slope = kDefaultCountSlope;
  /// Exactly so many stars; or else `density`.
  std::optional<std::int64_t> stars;
  /// Stars per square degree brighter than `density_limit` by the law without its bright end; Poisson numbers.
  std::optional<double> density;
  Magnitude density_limit{12.0};
  std::uint64_t seed = 1;
};

/// Makes a field of stars, uniform on the sky, independent of each other, the brightest first, with ids
/// "syn<seed>-<n>".
///
/// With a density, star n is the n-th arrival of a Poisson process along magnitude, so a fainter limit appends stars
/// and changes none. With a number of stars, magnitudes are that many independent draws from the law. The law is in the
/// notes. Positions are rounded to 1e-8 deg, magnitudes to 1e-4 mag.
/// @throws InputError with every problem of the request
/// @rng stream 1001, one star one counter   @thread safe
[[nodiscard]] StarCatalogue make_synthetic_field(const FieldRequest& request);

struct ExtensionRequest {
  SkyRegion region;  ///< where stars are counted and added; all extents 0: the enclosing cap of the catalogue
  std::optional<Magnitude> complete_to;  ///< nothing: from the turn-over of the counts, with a warning in the notes
  std::optional<double> slope;           ///< nothing: of the catalogue's counts over the last two magnitudes
  Magnitude faint{16.0};
  std::uint64_t seed = 1;
};

/// The law that extends a catalogue: brighter(m) = stars 10^(slope (m - complete_to)).
struct ExtensionLaw {
  SkyRegion region;
  Magnitude complete_to;
  double slope = kDefaultCountSlope;
  double slope_error = 0.0;  ///< standard error; 0 when the slope was given
  std::int64_t stars = 0;    ///< of the catalogue, in the region, brighter than complete_to
  std::int64_t added = 0;
};

/// Adds stars fainter than `complete_to`, so that the counts of the region follow the law down to `faint`; where the
/// catalogue has some of them, in steps of 0.25 mag, only the missing ones are added. Its own stars do not change, and
/// a fainter limit appends stars and changes none. New ids: "ext<seed>-<n>". The law is added to the notes.
/// @throws InputError for pixel and electron catalogues, and when too few stars stand behind the law
[[nodiscard]] ExtensionLaw extend_catalogue(StarCatalogue& catalogue, const ExtensionRequest& request);

}  // namespace astroid
