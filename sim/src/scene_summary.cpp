#include "astroid/sim/scene_summary.hpp"

#include <algorithm>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {
/// The part of a flux's own noise that an approximation may add as bias.
constexpr double kNoiseShare = 0.01;
}  // namespace

double SceneSummary::relative_variance_in_bin(double target_electrons) const {
  if (!(target_electrons > 0.0)) return 0.0;
  // Noise-equivalent area of the sharpest PSF a star can have, one pixel: a lower bound of the noise, so of the
  // tolerance.
  const double variance = target_electrons + pixel_noise_variance;
  return variance / (target_electrons * target_electrons) / (exposures_per_bin * static_cast<double>(cameras));
}

double SceneSummary::flux_tolerance(double target_electrons) const {
  return std::max(accuracy * target_electrons,
                  kNoiseShare * target_electrons * det::sqrt(relative_variance_in_bin(target_electrons)));
}

double SceneSummary::flux_change(double displacement) const {
  return std::min(1.0, displacement * (psf.gradient + 0.5 * displacement * psf.curvature));
}

double SceneSummary::tightest_tolerance() const {
  return flux_tolerance(faintest_target_electrons);
}

}  // namespace astroid
