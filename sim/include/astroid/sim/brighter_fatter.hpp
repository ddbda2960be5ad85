// Brighter-fatter: charge already collected pushes the boundaries of its pixel inwards, so bright stars are wider.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/mission/detector.hpp"

namespace astroid {

/// How far one electron moves the boundaries of the pixels around it.
class BoundaryShifts {
 public:
  /// A smooth model: the shift falls with the distance r between electron and boundary as E1(decay r) cos(theta), theta
  /// the angle to the boundary's normal, and is `serial` or `parallel` where r is half a pixel.
  /// @param settings  decay > 0; range 1 .. 16.
  /// @source Guyonnet2015 for the smooth model.
  explicit BoundaryShifts(const BrighterFatterSettings& settings);

  [[nodiscard]] int range() const { return range_; }
  /// Of a boundary between columns by an electron in the d-th pixel before it, j rows away; 0 <= d, j < range.
  [[nodiscard]] double serial(int d, int j) const { return serial_[index(d, j)]; }
  /// The same of a boundary between rows; j columns away.
  [[nodiscard]] double parallel(int d, int j) const { return parallel_[index(d, j)]; }
  /// Slope of variance / mean against the mean of a flat field, 1/e-: -2 (serial + parallel) of the nearest.
  [[nodiscard]] double photon_transfer_slope() const { return -2.0 * (serial_.front() + parallel_.front()); }

 private:
  [[nodiscard]] std::size_t index(int d, int j) const {
    return static_cast<std::size_t>(d) * static_cast<std::size_t>(range_) + static_cast<std::size_t>(j);
  }
  int range_;
  std::vector<double> serial_;
  std::vector<double> parallel_;
};

/// Moves charge across pixel boundaries as collected charge shifts them.
///
/// Across the boundary X of pixel 0 goes (Q_0 + Q_X) / 4 times the sum of a_i Q_i over the pixels on its side minus
/// that over those on the other. What one pixel gives its neighbour gets, so charge is conserved; none leaves the
/// image, and none comes from outside.
/// @param electrons  [in,out] after photon noise, e-, >= 0: on expected electrons the noise would not notice.
/// @returns     boundaries that would have moved more than a quarter of the charge of a pixel, and moved that much.
/// @accuracy    relative 1e-12 of the plain sum over pixels (test: BrighterFatter.IsTheSumOverAllPixels).
/// A pixel depends on those within range() in x and y.
/// @valid       0 .. full well: where shifts are small against 1.
/// @complexity  O(pixels x range²) (bench: BM_BrighterFatter)  @rng none  @thread safe
/// @source      Guyonnet2015.
std::int64_t brighter_fatter(const ImageView<double, unit::SampledElectrons>& electrons, const BoundaryShifts& shifts);

}  // namespace astroid
