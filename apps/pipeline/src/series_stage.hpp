// From fluxes to light curves: complete blocks go, star by star, to the statistics and the light-curve file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/analysis/nsr_accumulator.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/pipeline/attitude_correction.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "flux_block.hpp"

namespace astroid {

/// Receives blocks: of all cameras in turn, then the next exposures.
///
/// Every star of a block belongs to one task, so no order of additions depends on the threads.
class SeriesStage {
 public:
  /// @param own_flags     that hold for every exposure: [camera][target].
  /// @param corrections   for jitter, of each camera; empty: none.
  /// @param light_curves  the file; null: none.
  SeriesStage(std::vector<std::vector<std::uint32_t>> own_flags,
              std::vector<std::span<const CorrectionStretch>> corrections, std::int64_t exposures_per_bin,
              bool keep_bin_means, std::size_t longest_block, LightCurveWriter* light_curves);

  /// Begins a block; its tasks follow, in any order and several at a time.
  void begin(const FluxBlock& block);
  /// Tasks of a block: so many stars each; none for an empty block.
  [[nodiscard]] std::size_t tasks(const FluxBlock& block) const;
  void run(std::size_t task, const FluxBlock& block, StreamTimings& seconds);
  /// Ends a block.  @param flags  those that targets have only in some of its exposures.
  void end(const FluxBlock& block, std::vector<LightCurveFlag>& flags);

  [[nodiscard]] std::vector<SeriesSummary> summaries() const { return result_.statistics.summaries(); }
  /// Of the first bins of each target, [target][bin], where they are kept.
  [[nodiscard]] std::vector<float> bin_means(std::int64_t exposures) const {
    return all_bin_means(result_.statistics, exposures);
  }
  /// Before jitter correction; empty without one.
  [[nodiscard]] std::vector<SeriesSummary> measured_summaries() const;
  /// measurement_flag bits seen in any exposure, of each target.
  [[nodiscard]] const std::vector<std::uint32_t>& flags() const { return flags_; }
  /// Share of the exposures so far that have any flag, of each target.
  [[nodiscard]] std::vector<double> flagged_share() const;

 private:
  /// Statistics of the mean of the cameras.
  struct Mean {
    SeriesStatistics statistics;
    std::vector<double> sums;  // of the cameras so far, [target][exposure]
  };
  [[nodiscard]] Mean make_mean(std::size_t targets, std::int64_t exposures_per_bin, bool keep_bin_means) const;
  void add(Mean& mean, std::size_t target, const FluxBlock& block, std::span<const float> series) const;
  void correct(std::size_t target, const FluxBlock& block, std::span<float> series) const;

  std::vector<std::vector<std::uint32_t>> own_flags_;
  std::vector<std::span<const CorrectionStretch>> corrections_;
  std::size_t cameras_;
  std::size_t targets_;
  LightCurveWriter* light_curves_;
  std::size_t longest_block_;
  Mean result_;
  Mean measured_;  // before correction, where there is one
  std::vector<std::uint32_t> flags_;
  std::vector<std::int64_t> flagged_;  // exposures with any flag, of all cameras
  std::int64_t exposures_ = 0;         // of all cameras
};

}  // namespace astroid
