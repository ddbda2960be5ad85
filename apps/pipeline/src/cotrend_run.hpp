// Cotrending: what the bin means of all targets have in common is taken out of each.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/confidence.hpp"
#include "astroid/analysis/nsr_accumulator.hpp"
#include "astroid/analysis/target_metrics.hpp"
#include "astroid/photometry/cotrending.hpp"

namespace astroid {

/// The trends of a run, and how much of them each target has.
class Cotrending {
 public:
  /// @param bin_means  shape (targets, bins), relative deviations.
  /// @param series     of the same targets: what scatters within bins is a target's own noise.
  /// @param targets    trends are found in the brightest clean ones, 1000 at most.
  /// @param most       trends, at most.
  Cotrending(std::span<const float> bin_means, std::span<const SeriesSummary> series,
             std::span<const TargetMetrics> targets, std::size_t most);

  /// What is left of the noise of bin means, relative to the mean flux.
  [[nodiscard]] NoiseEstimate left(std::size_t target) const;
  [[nodiscard]] const CommonTrends& trends() const { return trends_; }
  /// Writes TRENDS, TARGETS and EIGENVALUES.  @param bin_seconds  length of a bin.  @throws EnvironmentError
  void write(const std::filesystem::path& file, std::span<const TargetMetrics> targets, double bin_seconds) const;

 private:
  CommonTrends trends_;
  std::vector<TrendFit> fits_;  // of each target
  std::vector<double> mean_;    // deviation of each target over the run
};

/// What cotrending did, for the page.
std::string cotrending_note(const Cotrending& cotrending, std::span<const TargetMetrics> targets);

}  // namespace astroid
