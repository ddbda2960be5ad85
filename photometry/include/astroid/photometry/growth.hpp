// How the light of stars grows with the radius of the aperture, and what an aperture leaves out.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/background.hpp"

namespace astroid {

/// Light of a typical star within a radius over that within `reference`.
struct GrowthCurve {
  std::vector<double> radius;  ///< px, ascending; the last is `reference`
  std::vector<double> light;   ///< relative to that within the last
  std::vector<double> error;   ///< of `light`, from the scatter of the stars
  std::size_t stars = 0;       ///< that were used
};

struct GrowthSettings {
  double radius = 3.0;     ///< px, of the aperture to be corrected
  double reference = 8.0;  ///< px, that all light is taken to be within
  int steps = 8;           ///< radii between the two
  std::size_t most_stars = 60;
  std::size_t fewest_stars = 5;
};

/// Measures the curve of growth from the brightest of `stars` (e.g. those that were found) that are whole, not
/// saturated or flagged, and have no neighbour of a hundredth of their light within the reference radius and half of it
/// more.
///
/// Ring by ring the median over stars of its light over that within `radius`, so that an unseen neighbour of one star
/// in some ring does no harm.
/// @param light  e-, of each star, for choosing; any scale.
/// @returns a curve without radii when fewer than `fewest_stars` are suited.
/// @throws InputError unless 0 < radius < reference, both finite, and there is at least one step
/// @source F153; Stetson1990, Howell1989; differs: medians instead of a model of the curve.
[[nodiscard]] GrowthCurve measure_growth(const Frame& frame, const BackgroundMap& background,
                                         std::span<const PixelPosition> stars, std::span<const double> light,
                                         const GrowthSettings& settings);

}  // namespace astroid
