// What light curves have in common, and what is left of each without it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace astroid {

/// The trends in one light curve.
struct TrendFit {
  double constant = 0.0;
  std::vector<double> amplitude;  ///< of each common trend
  double rms_before = 0.0;        ///< scatter of the series about its mean
  double rms_after = 0.0;         ///< about the fit, with the freedom of the fit taken into account
};

/// The principal trends of an ensemble of light curves in bins of time.
///
/// Each series is divided by what its scatter would be were all noise its own; common trends are the eigenvectors of
/// their correlation over time whose eigenvalue noise alone does not reach: white noise of M series in B bins stays
/// below (1 + sqrt(B / M))² on average over the series. An ensemble without anything in common has no trends, so that
/// nothing is fitted to noise.
/// @source F132; the edge of the spectrum: MarchenkoPastur1967; the idea of cotrending: Smith2012.
class CommonTrends {
 public:
  /// @param series  shape (stars, bins), relative deviations; a series with a gap (NaN) is left out.
  /// @param noise   shape (stars), rms of a bin that is no trend, > 0: photon noise and what else is the star's own.
  /// @param most    the most trends that are kept.
  CommonTrends(std::span<const float> series, std::span<const double> noise, std::size_t bins, std::size_t most);

  [[nodiscard]] std::size_t trends() const { return bins_ > 0 ? trends_.size() / bins_ : 0; }
  [[nodiscard]] std::size_t bins() const { return bins_; }
  /// Series that the trends were found in.
  [[nodiscard]] std::size_t references() const { return references_; }
  /// Shape (bins): mean zero, rms 1, orthogonal to the others; the strongest first.
  [[nodiscard]] std::span<const double> trend(std::size_t k) const {
    return std::span(trends_).subspan(k * bins_, bins_);
  }

  /// Eigenvalues of the correlation over the number of references, the largest first: of noise alone they stay below
  /// edge().
  [[nodiscard]] std::span<const double> eigenvalues() const { return eigenvalues_; }
  [[nodiscard]] double edge() const { return edge_; }

  /// Least-squares fit of all trends and a constant to one series.
  /// @param series  shape (bins); NaN is left out. With too few bins nothing is fitted, and rms_after is NaN.
  [[nodiscard]] TrendFit fit(std::span<const float> series) const;
  /// All trends of a fit, without the constant, in a bin.
  [[nodiscard]] double at(const TrendFit& fit, std::size_t bin) const;

 private:
  std::size_t bins_;
  std::size_t references_ = 0;
  double edge_ = 0.0;
  std::vector<double> eigenvalues_;
  std::vector<double> trends_;  // [trend][bin]
};

}  // namespace astroid
