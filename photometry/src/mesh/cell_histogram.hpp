// Clipped statistics of the pixels of one cell of a background mesh from a histogram, without sorting them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "astroid/photometry/background.hpp"

namespace astroid::detail {

/// Values in equal bins around their bulk. Counts are integers, so sums over bins are exact and of any order.
class CellHistogram {
 public:
  static constexpr std::size_t kBins = 1024;
  /// Fewer values are sorted instead: their median would be that of a handful of bins.
  static constexpr std::size_t kFewestValues = 1024;

  /// @param values  all finite.
  /// @param quantum  step of the values, over which each is spread; 0: none
  /// @returns false when the values have no scatter to make bins of, or are too few.
  bool fill(std::span<const float> values, double quantum);

  /// The same as clipped_sky() of the values, with limits at edges of bins.
  /// @returns false when the clipped range reaches beyond the bins: the values must be sorted.
  /// @accuracy level within 0.01, rms within 0.01 of the rms of a pixel (test: CellHistogramOf.IsTheSortedEstimate)
  bool clipped(double clip, bool mode, SkyEstimate& sky) const;

  /// Adds the counts to bins of width `step` rms around `level`, the first of which begins `reach` rms below it. Each
  /// of our bins is spread evenly over those it covers.
  void add_scaled(double level, double rms, double reach, double step, std::span<double> bins) const;

 private:
  [[nodiscard]] double edge(std::size_t bin) const { return origin_ + width_ * static_cast<double>(bin); }
  [[nodiscard]] double quantile_position(std::size_t first, std::size_t last) const;

  double origin_ = 0.0;
  double width_ = 0.0;
  std::array<std::uint32_t, kBins> count_{};
  // Sums over the bins before: of counts, and of counts times the bin's number and its square.
  std::array<std::int64_t, kBins + 1> before_{};
  std::array<std::int64_t, kBins + 1> first_{};
  std::array<std::int64_t, kBins + 1> second_{};
};

/// The same of values that were sorted.
void add_scaled(std::span<const double> values, double level, double rms, double reach, double step,
                std::span<double> bins);

/// Smallest step between different values, 0 for none or where it is below a hundredth of their scatter: what
/// digitisation left.
[[nodiscard]] double quantum_of(std::span<const float> values);

}  // namespace astroid::detail
