// The noise budget without a simulation: isolated stars of given magnitudes, seen by the mission's camera.
#pragma once

#include <span>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// A row of analysis/noise_budget.csv: a star at the centre of a pixel on the optical axis.
struct BudgetRow {
  double mag = 0.0;             ///< in the passband of the zero point
  double electrons = 0.0;       ///< per exposure, all of the PSF
  double peak_electrons = 0.0;  ///< of the star in its brightest pixel, per exposure
  bool saturated = false;       ///< the brightest pixel with its background is above full well or the ADC's range
  int mask_pixels = 0;
  double enclosed_fraction = 0.0;
  double nsr_exposure = 0.0;  ///< one exposure, one camera, without jitter
  double nsr_1h_ppm = 0.0;    ///< one bin, all cameras
  NoiseByCause causes;        ///< of it, ppm
  double spr_tot = 0.0;       ///< share of the neighbours in the star light of the aperture (F20)
};

/// A star beside the one that the budget is of.
struct BudgetNeighbour {
  double dx = 0.0, dy = 0.0;  ///< px
  DeltaMag fainter;           ///< by how much than the star; negative: brighter
};

/// The analytic budget of a mission. It uses the estimators of the photometry, so mask and aperture are those that a
/// run would use.
/// @param psf         of the mission.
/// @param neighbours  of each star; none: isolated.
/// @throws InputError when the photometry's settings contradict themselves.
std::vector<BudgetRow> analytic_budget(const Mission& mission, const PixelPsf& psf, std::span<const double> magnitudes,
                                       std::span<const BudgetNeighbour> neighbours = {});

/// The estimator of the first star in a field of its own: pixels all around it as far as its photometry reaches, the
/// other stars as neighbours. Positions as on any frame.
StarEstimator estimator_of_first(const Mission& mission, const PixelPsf& psf, std::span<const FieldStar> stars);

}  // namespace astroid
