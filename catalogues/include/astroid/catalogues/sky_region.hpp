// A part of the sky, and points spread uniformly over it.
#pragma once

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// A cap when `radius` is above 0, else a box around the centre: `width` along the great circle through the centre from
/// west to east, `height` across it, both as seen from the centre. No pole and no wrap of right ascension is special.
struct SkyRegion {
  SkyPosition centre;
  Degrees radius{0.0};  ///< up to 180
  Degrees width{0.0};   ///< up to 360
  Degrees height{0.0};  ///< up to 180
};

/// Area in square degrees; the whole sky has 41252.96. @throws InputError when the region is empty or larger than the
/// sky
[[nodiscard]] double square_degrees(const SkyRegion& region);

[[nodiscard]] bool contains(const SkyRegion& region, SkyPosition position);

/// The point of the region at two numbers in [0, 1]: equal areas of the unit square are equal areas of the sky.
/// @accuracy 1e-13 deg
[[nodiscard]] SkyPosition point_of(const SkyRegion& region, double u, double v);

/// The smallest cap that holds all the stars; its radius is at most 1 % larger. @throws InputError for pixel
/// catalogues, and for stars all over the sky, which have no mean direction
[[nodiscard]] SkyRegion enclosing_cap(const StarCatalogue& catalogue);

}  // namespace astroid
