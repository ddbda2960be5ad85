// What pixels without light say of a frame: the level of its columns (overscan rows) and of all of it (prescan).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"

namespace astroid {

/// Noise that the ground expects of a reference pixel, to tell a cosmic ray from it.
struct ReferenceNoise {
  double readout = 0.0;  ///< ADU rms, readout and quantisation together
  double gain = 1.0;     ///< e-/ADU, for the photon noise of what is smeared into overscan rows
  double bias = 0.0;     ///< ADU, where that noise begins
  /// ADU rms of a pixel of that level.
  [[nodiscard]] double rms(double level) const;
};

/// Values farther than this many sigma from the median of their column are left out of its mean: so far out that the
/// mean of good pixels keeps its value (2e-9 of them), yet a cosmic ray below it moves the mean of 30 rows by less
/// than its own error.
inline constexpr double kReferenceClip = 6.0;

/// Mean of each column over some rows, cosmic rays left out.
///
/// The plain mean where no value is far from it, which costs one pass; only columns with an outlier are sorted. Sums
/// run down the rows in order. A column of which no finite value is left has level NaN.
/// @param rows    reference rows, one or more.
/// @param levels  [out] shape (rows.nx()), ADU.
/// @rng none @thread safe
/// @complexity  O(pixels)  (bench: BM_ColumnLevels)
/// @accuracy    unbiased within the clip; its variance is that of a pixel / rows
///              (test: ColumnLevels.AreUnbiasedWithTheVarianceOfAMean)
void column_levels(const ImageView<const float, unit::Adu>& rows, const ReferenceNoise& noise,
                   std::span<double> levels);

/// Mean of values with outliers left out: the same rule for pixels that all have one level.
/// @param values  in any order; sorted by the call where one is far out.  @returns NaN where no finite value is left.
[[nodiscard]] double reference_level(std::vector<float>& values, const ReferenceNoise& noise);

}  // namespace astroid
