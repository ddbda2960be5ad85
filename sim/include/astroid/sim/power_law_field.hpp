// Random fields whose power falls with spatial frequency as a power law ("1/f" in space): large-scale flat fields.
#pragma once

#include <cstddef>
#include <vector>

#include "astroid/core/random.hpp"

namespace astroid {

/// A Gaussian random field over a whole detector, isotropic, with power proportional to frequency^-exponent.
///
/// Made by Fourier transform on a grid of smooth size (at most 6 % larger than the detector), so a period of the grid's
/// size. Amplitudes of all frequencies are complex normals of variance f^-exponent, f = |(kx / nx, ky / ny)| in cycles
/// a pixel, 0 at f = 0 (Timmer and Koenig 1995); then mean 0 and the rms are set over the detector. The same bits on
/// every processor.
///
/// A detector with more than 8192 px a side has a grid of half, a third, ... of its resolution, each cell being
/// constant.
/// @rng    pixel words of the frequencies (kx, ky), draws 0 and 1, exposure 0.
/// @accuracy  mean 0 and rms to 1e-6 of the rms (single precision); slope and isotropy: test PowerLawField.*.
/// @complexity  O(n log n), 8 bytes a pixel while it is made, then 4 (bench: BM_PowerLawField)
/// @source Timmer1995.
class PowerLawField {
 public:
  /// @param rms  of the field over the detector.  @param exponent  0: white; 1: 1/f; larger: smoother.
  PowerLawField(const RandomStream& stream, int columns, int rows, double exponent, double rms);

  [[nodiscard]] double at(int x, int y) const {
    return static_cast<double>(
        values_[static_cast<std::size_t>(y / cell_) * stride_ + static_cast<std::size_t>(x / cell_)]);
  }
  /// Side of the cells that have one value, px.
  [[nodiscard]] int cell() const { return cell_; }

 private:
  void draw(const RandomStream& stream, int columns, int rows, double exponent);
  void transform_columns(int columns, int rows);
  void transform_rows(int columns, int rows);
  void normalise(int columns, int rows, double rms);

  int cell_ = 1;
  std::size_t stride_ = 0;
  std::vector<float> values_;  ///< of the grid, row by row; before the last step real and imaginary halves of each row
};

}  // namespace astroid
