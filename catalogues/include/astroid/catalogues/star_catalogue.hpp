// A star catalogue in memory, whatever file it came from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// How the positions of a catalogue are given.
enum class PositionKind { kSky, kPixel };
/// What its brightness column means.
enum class BrightnessKind { kMagnitude, kElectrons };

/// One star as catalogued. For a pixel catalogue `pixel` counts, for a sky catalogue `sky`.
struct CatalogueStar {
  std::string id;
  SkyPosition sky;
  PixelPosition pixel;
  Magnitude magnitude;     ///< in the catalogue's passband (kMagnitude)
  double electrons = 0.0;  ///< per exposure (kElectrons)
  double colour = 0.0;     ///< B-V, B_T-V_T or BP-RP, as `colour_index` of the catalogue says; NaN: unknown
  double teff = 0.0;       ///< K; NaN: unknown
  double pm_ra = 0.0;      ///< proper motion in right ascension times cos(dec), mas/yr; 0 where unknown
  double pm_dec = 0.0;     ///< and in declination, mas/yr
  double epoch = 0.0;      ///< Julian year of its position; 0: that of the whole catalogue
};

struct StarCatalogue {
  std::string source;        ///< file it came from
  std::string passband;      ///< V, V_T, P, G, T, Kp, …
  std::string colour_index;  ///< B-V, B_T-V_T, BP-RP or empty
  PositionKind positions = PositionKind::kSky;
  BrightnessKind brightness = BrightnessKind::kMagnitude;
  std::vector<CatalogueStar> stars;  ///< ids are unique; order of the file
  std::vector<std::string> notes;    ///< what was assumed or left out, for the report
};

/// Stable 64-bit hash of an id: the address of a star's random draws.
std::uint64_t star_hash(const std::string& id);

}  // namespace astroid
