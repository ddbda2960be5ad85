// The ramp fit of many pixels, read by read: nothing but three numbers of a pixel is kept between reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/ramp.hpp"

namespace astroid {

/// Weights of ramps for every charge: those of a ladder of charges, close enough that a pixel may use the nearest.
/// @accuracy  the variance is at most 0.1 % above that of a pixel's own weights
///            (test: RampLadder.IsAsGoodAsOwnWeights).
class RampLadder {
 public:
  /// @param reads  2 or more.  @param read_variance  of one read, e-²: readout and quantisation noise.
  RampLadder(RampFit fit, int reads, double read_variance);

  [[nodiscard]] int intervals() const { return intervals_; }
  /// The weights for a pixel that expects so many electrons in the exposure.
  [[nodiscard]] std::uint8_t level(double electrons) const;
  [[nodiscard]] RampVariance variance(std::uint8_t level, int used) const { return weights_[level].variance(used); }

  /// c_i and a_i of increment i and 1 / information of `used` increments times their number, by level.
  [[nodiscard]] std::span<const double> carries(int i) const { return row(carries_, i); }
  [[nodiscard]] std::span<const double> shares(int i) const { return row(shares_, i); }
  [[nodiscard]] std::span<const double> scales(int used) const { return row(scales_, used); }

 private:
  [[nodiscard]] std::span<const double> row(const std::vector<double>& table, int i) const {
    return std::span(table).subspan((static_cast<std::size_t>(i) - 1) * weights_.size(), weights_.size());
  }

  int intervals_;
  double per_electron_;  // φ of one electron
  std::vector<RampWeights> weights_;
  std::vector<double> carries_, shares_, scales_;  // [increment][level]
};

/// What is kept of some pixels between two reads.
struct RampPixels {
  std::span<const std::uint8_t> level;  ///< of the ladder
  std::span<float> previous;            ///< the last read, ADU
  std::span<double> carried;            ///< z of RampWeights, ADU
  std::span<double> numerator;          ///< ADU
  std::span<std::uint8_t> used;         ///< increments so far
};

/// Takes in read number `read`, 0 … intervals. Pixels flagged as saturated take part no more.
/// @param counts  digitised, ADU.  @param flags  pixel_flag of the exposure so far.
/// @complexity O(pixels) (bench: BM_RampRead)  @rng none  @thread safe
void take_ramp_read(const RampLadder& ladder, int read, std::span<const float> counts,
                    std::span<const std::uint8_t> flags, const RampPixels& pixels);

/// The counts of the whole exposure after the last read, without any offset: not rounded, may be negative.
///
/// A pixel that saturated after at least one increment is fitted by what it had before; it loses the flags of
/// saturation and gains pixel_flag::kShortRamp. Where no increment is left, `saturated` is delivered, the flags stay.
void finish_ramp(const RampLadder& ladder, double saturated, const RampPixels& pixels, std::span<double> counts,
                 std::span<std::uint8_t> flags);

}  // namespace astroid
