// What cutting the spectrum of a PSF of limited extent does to fluxes, measured.
#pragma once

#include <functional>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/psf_spectrum.hpp"

namespace astroid::detail {

/// Exact light in a rectangle, px from the star.
using RectangleFlux = std::function<double(PixelPosition lower, PixelPosition upper)>;

/// Compares the light in squares of 1 to 5 px by the frequencies within a band with the exact one, at 64 sub-pixel
/// phases, in squares about the star and at the borders of the PSF, where its light may end in a step.
class BandError {
 public:
  /// @param lower, upper  extent of the PSF, px from the star: no light beyond
  BandError(PixelPosition lower, PixelPosition upper, const RectangleFlux& exact);

  /// The largest difference, relative to the star's flux.
  [[nodiscard]] double of(const PsfSpectrum& spectrum, double band) const;

 private:
  double period_;
  std::vector<double> columns_;  // centres of the squares
  std::vector<double> lines_;
  std::vector<double> exact_;  // [column][width][line]
};

}  // namespace astroid::detail
