// The light of whole columns of a detector: what charge collects while it is clocked through them.
#pragma once

#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

/// Adds what a star gives to columns, summed over the rows of the detector: the marginal of the PSF where the star is
/// far from the first and last row, what is left of it near them.
///
/// Only the stamp of the star counts (StarLight::half_width); motion is not looked at.
/// @param detector  light that falls beside it is lost.
/// @param columns   [in,out] e- per exposure of columns x0, x0 + 1, …; those beside the detector gain nothing.
/// @param scratch   resized as needed.
/// @accuracy  of PixelPsf::integrate(): with a Gaussian 1e-12 of the star's light
///            (test: ColumnLight.IsTheMarginalOfTheStamp)
/// @complexity  O(pixels of the stamp within the columns)
void add_column_light(const PixelPsf& psf, const StarLight& star, const Rectangle& detector, int x0,
                      std::span<double> columns, std::vector<double>& scratch);

/// Adds the change of the same with the star's position, to first order.
/// @param along_x, along_y  [in,out] e- per exposure and px of displacement; away from the first and last row the
/// change
///                          along y is 0.
void add_column_gradient(const PixelPsf& psf, const StarLight& star, const Rectangle& detector, int x0,
                         std::span<double> along_x, std::span<double> along_y, std::vector<double>& scratch);

/// Share of a column's light that a row collects while all rows are clocked through the column once.
/// @param seconds   of clocking all rows past one pixel.  @param exposure  s, that the light was collected in.
/// @returns  seconds / (rows × exposure); 0 where there is no row or no exposure, so a column without light stays dark.
/// @source F30
[[nodiscard]] double clocking_share(double seconds, double exposure, int rows);

}  // namespace astroid
