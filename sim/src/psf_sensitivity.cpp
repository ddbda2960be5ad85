#include "psf_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace astroid {

namespace {

constexpr int kPhases =
    8;  ///< sub-pixel phases an axis; motion is taken along x, the PSF's worst axis by symmetry of the masks
constexpr int kLargestMask = 5;  ///< px
constexpr double kLeastEnclosed = 0.3;
constexpr double kStep = 0.01;  ///< px, of the finite differences

double mask_flux(const PixelPsf& psf, PixelPosition centre, Rectangle mask, std::vector<double>& scratch) {
  scratch.resize(mask.size());
  psf.integrate(centre, mask, scratch);
  double sum = 0.0;
  for (const double fraction : scratch) sum += fraction;
  return sum;
}

/// d^n f / dx^n at 0 from n + 1 values, half a step beside whole ones where n is odd.
template <class Function>
double central_difference(const Function& f, std::size_t n) {
  constexpr double kWideStep = 0.05;  // px: the sixth derivative still has seven digits
  const auto order = static_cast<double>(n);
  double sum = 0.0;
  double binomial = 1.0;  // n over k, with its sign
  double scale = 1.0;
  for (std::size_t k = 0; k <= n; ++k) {
    const auto step = static_cast<double>(k);
    sum += binomial * f((0.5 * order - step) * kWideStep);
    binomial *= -(order - step) / (step + 1.0);
    if (k > 0) scale *= kWideStep;
  }
  return sum / scale;
}

/// At a pixel (x0, y0): the largest numbers so far and there.
void measure_at(const PixelPsf& psf, int x0, int y0, PsfSensitivity& sensitivity) {
  std::vector<double> scratch;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double offset = static_cast<double>(phase) / kPhases - 0.5;
    for (const bool along_x : {true, false}) {
      for (int size = 2; size <= kLargestMask; ++size) {
        const Rectangle mask{x0 - size / 2, y0 - size / 2, size, size};
        const auto flux_at = [&](double shift) {
          const PixelPosition centre = along_x ? PixelPosition{x0 + offset + shift, static_cast<double>(y0)}
                                               : PixelPosition{static_cast<double>(x0), y0 + offset + shift};
          return mask_flux(psf, centre, mask, scratch);
        };
        const double middle = flux_at(0.0);
        if (middle < kLeastEnclosed) continue;
        for (std::size_t n = 1; n < sensitivity.derivatives.size(); ++n)
          sensitivity.derivatives[n] =
              std::max(sensitivity.derivatives[n], std::abs(central_difference(flux_at, n)) / middle);
        const double left = flux_at(-kStep);
        const double right = flux_at(kStep);
        sensitivity.gradient = std::max(sensitivity.gradient, std::abs(right - left) / (2.0 * kStep * middle));
        sensitivity.curvature =
            std::max(sensitivity.curvature, std::abs(right - 2.0 * middle + left) / (kStep * kStep * middle));
      }
    }
    for (int row = 0; row < kPhases; ++row) {
      const PixelPosition centre{x0 + offset, y0 + static_cast<double>(row) / kPhases - 0.5};
      sensitivity.peak_fraction = std::max(sensitivity.peak_fraction, mask_flux(psf, centre, {x0, y0, 1, 1}, scratch));
    }
  }
}

}  // namespace

PsfSensitivity measure_sensitivity(const PixelPsf& psf) {
  PsfSensitivity sensitivity;
  for (const PixelPosition& place : psf.places())
    measure_at(psf, static_cast<int>(std::floor(place.x)), static_cast<int>(std::floor(place.y)), sensitivity);
  return sensitivity;
}

}  // namespace astroid
