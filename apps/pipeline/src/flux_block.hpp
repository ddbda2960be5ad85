// What one camera measured in consecutive exposures: written batch by batch, read star by star.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/attitude.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// Fluxes of all targets in a block of exposures, and what else is added up exposure by exposure.
///
/// Workers fill different exposures at the same time; when all have been filled, the series of different targets may be
/// read at the same time. A block is used again and again.
class FluxBlock {
 public:
  /// Exposures that lie side by side in memory: a batch lies within them.
  static constexpr std::size_t kSideBySide = EstimatorSet::kMaxBatch;

  /// Sets memory aside for so many exposures of so many targets: 4 bytes for each.
  FluxBlock(std::size_t targets, std::size_t longest);

  /// Empties the block for exposures first … first+count-1 of a camera.
  void begin(int camera, std::int64_t first, std::size_t count);

  [[nodiscard]] int camera() const { return camera_; }         ///< from 0
  [[nodiscard]] std::int64_t first() const { return first_; }  ///< exposure
  [[nodiscard]] std::size_t count() const { return count_; }   ///< exposures
  [[nodiscard]] bool empty() const { return count_ == 0; }

  /// Where flux / reference - 1 of a target goes, NaN where unmeasurable, for `count` exposures of the block from
  /// `begin` on, all of them within one multiple of kSideBySide.
  [[nodiscard]] std::span<float> deviation(std::size_t target, std::size_t begin, std::size_t count) {
    float* line = deviation_[begin / kSideBySide * targets_ + target].data();
    return {line + begin % kSideBySide, count};
  }

  /// Copies the series of targets first_target … last_target-1.  @param out  shape (targets, count()).
  void copy_series(std::size_t first_target, std::size_t last_target, std::vector<float>& out) const;

  /// What the ground takes for the mean attitude, by exposure; where it corrects for it.
  [[nodiscard]] std::span<Attitude> attitudes() { return std::span(attitudes_).first(count_); }
  [[nodiscard]] std::span<const Attitude> attitudes() const { return std::span(attitudes_).first(count_); }

  /// Electrons that left the frame, and pixels clipped by the ADC, by exposure.
  [[nodiscard]] std::span<double> lost() { return std::span(lost_).first(count_); }
  [[nodiscard]] std::span<std::int64_t> clipped() { return std::span(clipped_).first(count_); }

 private:
  struct alignas(64) Line : std::array<float, kSideBySide> {};  // of a cache

  std::size_t targets_;
  int camera_ = 0;
  std::int64_t first_ = 0;
  std::size_t count_ = 0;
  // [exposure / kSideBySide][target][exposure % kSideBySide]: what a batch writes lies together, and what a few targets
  // are read from does, too.
  std::vector<Line> deviation_;
  std::vector<Attitude> attitudes_;
  std::vector<double> lost_;
  std::vector<std::int64_t> clipped_;
};

}  // namespace astroid
