// Noise of a sum of pixels: the CCD equation, the noise-to-signal ratio of a mask and the masks that minimise it.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "astroid/core/ramp.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// What makes noise in one pixel besides the stars.
struct PixelNoise {
  double background = 0.0;    ///< expected sky + dark, e- per pixel and exposure
  double readout = 0.0;       ///< e- rms
  double quantisation = 0.0;  ///< e- rms, gain / sqrt(12)
  RampNoise ramp{};           ///< how often the pixel is read; `readout` and `quantisation` are of one read
  double column = 0.0;        ///< e- rms of one read that all pixels of a column share; no part of variance()
  double row = 0.0;           ///< the same of a row
  /// Share of a pixel's signal in each neighbour at its sides and corners (F91), which correlates photon noise.
  double side_coupling = 0.0, corner_coupling = 0.0;

  /// Variance of a pixel without stars, e-².
  [[nodiscard]] double variance() const { return variance(0.0); }
  /// Variance of a pixel in which stars are expected to give `light` e-, e-².
  [[nodiscard]] double variance(double light) const;
  /// What the fit of a ramp makes of photon and readout noise in such a pixel; 1 and 1 for a single read.
  [[nodiscard]] RampVariance factors(double light) const {
    return ramp.variance(light + background, readout * readout + quantisation * quantisation);
  }
};

/// The terms of the CCD equation, electrons per exposure.
struct CcdEquation {
  double star = 0.0;                                                   ///< e-, whole aperture
  double pixels = 1.0;                                                 ///< n_pix of the aperture
  double background_pixels = std::numeric_limits<double>::infinity();  ///< n_B that the background was measured in
  double sky = 0.0;                                                    ///< e- per pixel
  double dark = 0.0;                                                   ///< e- per pixel
  double readout_noise = 0.0;                                          ///< e- rms
  double gain = 1.0;                                                   ///< e-/ADU
  double adc_noise = 0.28867513459481288225;  ///< ADU rms, 1 / sqrt(12) for a perfect converter
};

/// Signal to noise of an aperture. @source MerlineHowell1995; Howell, Handbook of CCD Astronomy.
/// @valid Gaussian limit, independent pixels, no flat-field errors, no saturation, constant sky.
double ccd_equation_snr(const CcdEquation& terms);

/// Noise-to-signal ratio of one exposure of one camera with weights w: sqrt(sum var_n w_n^2) / sum target_n w_n.
///
/// @param target, total  shape (pixels), e- per exposure of the target alone and of all stars with it.
/// @param weights        shape (pixels); a binary mask has 0 and 1. Invariant under a common factor.
/// @returns              relative; +inf when the weighted target is not positive.
/// @valid                independent pixels and exposures; jitter, flat-field errors and drift are not in it.
/// @source Marchiori2019 Eq. 11; GutierrezCanales2026 Eq. 2.
double nsr_exposure(std::span<const double> target, std::span<const double> total, std::span<const double> weights,
                    const PixelNoise& noise);

/// The same for the binary mask that consists of the given pixels.
double nsr_of_mask(std::span<const double> target, std::span<const double> total, std::span<const std::size_t> mask,
                   const PixelNoise& noise);

/// NSR of the mean of independent measurements: one camera's exposures times the cameras.
/// @source Marchiori2019 Eq. 12 with 12 = sqrt(3600 / 25). White noise only.
Ppm nsr_averaged(double nsr, double exposures, double cameras);

/// A mask on its way from the best pixel to all pixels.
struct MaskGrowth {
  std::vector<std::size_t> order;    ///< pixels by rising NSR, those without target flux left out
  std::vector<double> nsr;           ///< NSR of the mask of the first i+1 pixels
  std::vector<std::size_t> allowed;  ///< mask sizes that do not split a tie, rising
};

/// Grows the mask pixel by pixel in order of rising pixel NSR, sqrt(var_n) / target_n.
///
/// Pixels whose NSR agree within kNsrTie belong together, so that a symmetric PSF has symmetric masks whatever the last
/// bits are; among them the order is that of the indices. @source Marchiori2019 Sect. 4.6.3, Eqs. 36-37.
MaskGrowth grow_mask(std::span<const double> target, std::span<const double> total, const PixelNoise& noise);

/// Relative difference of pixel NSRs below which two pixels go into a mask together: far above rounding, far below
/// what moving a star by 1e-6 px does.
inline constexpr double kNsrTie = 1e-9;

/// Pixels of the optimal binary mask: the global minimum of the NSR over the masks that grow_mask() allows.
///
/// Differs from PlatoSim, which stops at the first pixel that does not improve the NSR: behind a contaminated pixel
/// there may be better ones.
/// @returns indices into the spans in growth order; empty when no pixel has target flux.
/// @source Marchiori2019 Sect. 4.6.3.
std::vector<std::size_t> optimal_binary_mask(std::span<const double> target, std::span<const double> total,
                                             const PixelNoise& noise);

/// Weights that minimise nsr_exposure() over all real weights: w_n = target_n / var_n, scaled to a largest weight of 1.
///
/// By Cauchy-Schwarz (sum t w)^2 <= (sum t^2 / var) (sum var w^2) with equality for w = t / var, so the global minimum
/// of the NSR is 1 / sqrt(sum t^2 / var). All zero when no pixel has target flux. @source Naylor1998.
std::vector<double> optimal_weights(std::span<const double> target, std::span<const double> total,
                                    const PixelNoise& noise);

}  // namespace astroid
