// Noise of a sum of pixels and the bounds that theory puts on it. SCIENCE: F5, F7-F9, F40, F41.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

/// What makes noise in one pixel besides the stars.
struct PixelNoise {
  double background = 0.0;    ///< expected sky + dark, e- per pixel and exposure
  double readout = 0.0;       ///< e- rms
  double quantisation = 0.0;  ///< e- rms, gain / sqrt(12)
  [[nodiscard]] double variance() const { return background + readout * readout + quantisation * quantisation; }
};

/// Signal to noise of an aperture by the CCD equation.
/// @source MerlineHowell1995; F5. @param background_pixels  n_B, +inf for a known background.
double ccd_equation_snr(double star_electrons, double pixels, double background_pixels, double sky, double dark,
                        double readout_noise, double gain, double sigma_adc);

/// Noise-to-signal ratio of one exposure of one camera with weights w (F7, Marchiori2019 Eq. 11).
/// @param target, total  e- per pixel of the target alone and of all stars; `noise` per pixel.
double nsr_exposure(std::span<const double> target, std::span<const double> total, std::span<const double> weights,
                    const PixelNoise& noise);

/// Pixels of the optimal binary mask: the global minimum of the aggregate NSR over masks grown in order of rising
/// pixel NSR (F9, Marchiori2019 §4.6.3). Ties within `tie` (relative) go in or out together.
/// @returns indices into the spans in growth order; empty when no pixel has target flux.
std::vector<std::size_t> optimal_binary_mask(std::span<const double> target, std::span<const double> total,
                                             const PixelNoise& noise);

/// Noise-equivalent area 1/sum(p^2) in pixels (F40).
double noise_equivalent_area(std::span<const double> fractions);

}  // namespace astroid
