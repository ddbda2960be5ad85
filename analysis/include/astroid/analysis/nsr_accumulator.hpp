// Noise of light curves measured as they stream past, star by star, in memory that does not grow with the exposures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/analysis/confidence.hpp"

namespace astroid {

/// What the light curve of one star says of its noise. Everything is relative to the star's mean flux.
struct SeriesSummary {
  std::int64_t exposures = 0;  ///< measured
  std::int64_t missing = 0;    ///< NaN
  double mean = 0.0;           ///< of the relative deviation from the reference flux; NaN without exposures
  NoiseEstimate exposure;      ///< std over all exposures / mean flux: NSR of one exposure
  std::int64_t bins = 0;       ///< bins of which at least half the exposures were measured
  /// NSR of a bin from within bins: mean over bins of the std within the bin, each divided by its c4, / sqrt(exposures
  /// per bin). Blind to noise slower than a bin; unbiased for white noise.
  NoiseEstimate bin_within;
  /// NSR of a bin from bin means: std of the bin means, each weighted by its exposures, divided by c4(bins). Sees all
  /// noise.
  NoiseEstimate bin_means;
};

/// Streaming statistics of many light curves.
///
/// A bin is a fixed range of exposure numbers, so every result is the same, bit for bit, however the exposures were cut
/// into blocks. Single pass and stable: sums are taken within a bin about the bin's first value, every eighth exposure
/// of the bin in one sum; bins are merged by ChanGolubLeVeque1983.
/// @accuracy    1e-12 relative of a two-pass calculation (test: SeriesStatistics.AgreesWithTwoPasses).
/// @complexity  O(exposures) time, O(stars) memory.
/// @thread      different stars may be fed at the same time.
/// @source      ChanGolubLeVeque1983
class SeriesStatistics {
 public:
  /// @param exposures_per_bin  >= 2; 144 is an hour at a cycle of 25 s.
  /// @param keep_bin_means  4 bytes for each bin of each star.
  SeriesStatistics(std::size_t stars, std::int64_t exposures_per_bin, bool keep_bin_means = false);

  [[nodiscard]] std::size_t stars() const { return stars_.size(); }
  [[nodiscard]] std::int64_t exposures_per_bin() const { return per_bin_; }

  /// Adds consecutive exposures of one star, first, first + 1, …: blocks come in rising order and may leave gaps.
  /// @param deviation  flux / reference - 1; NaN is counted as missing.
  void add(std::size_t star, std::int64_t first, std::span<const float> deviation);

  /// The result so far; more exposures may follow.
  [[nodiscard]] SeriesSummary summary(std::size_t star) const;
  [[nodiscard]] std::vector<SeriesSummary> summaries() const;
  /// Mean deviation of a star in each of the first bins, NaN where fewer than half of a bin was measured; empty unless
  /// they were kept.  @returns shape (bins)
  [[nodiscard]] std::vector<float> bin_means(std::size_t star, std::size_t bins) const;

 private:
  // Running sums of a bin: an exposure goes to the one that its place in the bin names, whatever block it came in.
  static constexpr std::size_t kLanes = 8;
  static double total(const std::array<double, kLanes>& lanes);

  struct Star {
    std::int64_t next = 0;  // first exposure not yet seen
    std::int64_t n = 0, missing = 0;
    double mean = 0.0, m2 = 0.0;  // of all exposures in closed bins
    std::int64_t bins = 0, within_dof = 0;
    double deviation_sum = 0.0;                         // of std / c4 over bins
    double weight = 0.0, bin_mean = 0.0, bin_m2 = 0.0;  // of bin means, weighted by their exposures
    std::int64_t open_bin = -1, open_n = 0;
    double shift = 0.0;                               // the first value of the open bin
    std::array<double, kLanes> sum{}, sum_squares{};  // of the open bin, about its first value
    std::vector<float> bin_means;                     // of closed bins, where they are kept
  };
  static void add_to_bin(Star& star, std::size_t place, std::span<const float> deviation);
  void close(Star& star) const;

  std::int64_t per_bin_;
  bool keep_bin_means_;
  std::vector<double> c4_;  // by number of exposures
  std::vector<Star> stars_;
};

/// The bin means of every star of so many exposures.  @returns shape (stars, bins); empty unless they were kept
std::vector<float> all_bin_means(const SeriesStatistics& statistics, std::int64_t exposures);

}  // namespace astroid
