// How much of a target's light is somebody else's, and whose.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// A neighbour in the aperture of a target.
struct Contaminant {
  std::string id;
  double dx = 0.0, dy = 0.0;  ///< from the target, px
  double electrons = 0.0;     ///< per exposure, all of its PSF
  double spr = 0.0;           ///< SPR_k: its share of all star light in the aperture, sky excluded
};

/// A row of analysis/contamination.csv.
struct ContaminationRow {
  std::string id;
  double mag = 0.0;
  double spr_tot = 0.0;
  double delta_mag = 0.0;              ///< 2.5 log10(1 - spr_tot), how much brighter the aperture looks
  std::vector<Contaminant> strongest;  ///< by falling spr
};

/// The neighbours with the largest share in each target's aperture.
///
/// @param reach  neighbours farther than this in x or y are not considered, px.
/// @param count  at most so many per target; those without any light in the aperture are left out.
/// @param threads  the result does not depend on it; < 1: as many as the process may run.
/// @returns one list per estimator, in their order.
std::vector<std::vector<Contaminant>> strongest_contaminants(std::span<const StarEstimator> estimators,
                                                             const PixelLayout& layout, const GroundModel& model,
                                                             double reach, std::size_t count, int threads = 1);

/// A series of equal transits or eclipses.
struct TransitSeries {
  double depth = 0.0;     ///< relative
  double duration = 0.0;  ///< h
  double count = 0.0;     ///< transits observed
};
/// Significance of transits on the target itself. @param nsr_1h  relative. @source GutierrezCanales2026
double planet_significance(const TransitSeries& transits, double nsr_1h);
/// Significance of eclipses on a contaminant with share spr_k. @source Marchiori2019 Eq. 28 corrected
double contaminant_significance(const TransitSeries& eclipses, double spr_k, double spr_tot, double nsr_1h);
/// The share from which eclipses on a contaminant look like transits, significance `threshold`.
/// @source Marchiori2019 Eq. 23 corrected
double critical_spr(const TransitSeries& eclipses, double spr_tot, double nsr_1h, double threshold);
inline constexpr double kDetectionThreshold = 7.1;  ///< eta_min of the PLATO pipeline

}  // namespace astroid
