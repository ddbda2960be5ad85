// Up-the-ramp fits: an exposure that is read several times without a reset between becomes one number of electrons.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace astroid {

/// How the reads of a ramp are weighted.
enum class RampFit {
  kDifference,    ///< the last read minus the first: correlated double sampling
  kLeastSquares,  ///< the straight line of unweighted least squares: best where readout noise dominates
  kOptimal,       ///< generalised least squares for the charge that the pixel is expected to hold
};

/// The variance of a fitted ramp of F electrons whose reads each have the variance R²: photon F + readout R².
struct RampVariance {
  double photon = 1.0;
  double readout = 1.0;
};

/// The weights of the increments d_i between the n + 1 reads of a ramp, i = 1 … n.
///
/// Increments are correlated: each read belongs to two of them. In units of R² their covariance is tridiagonal,
/// φ + 2 on the diagonal and -1 beside it, where φ is the photon variance of one increment over R². The best linear
/// unbiased estimate of the electrons of the whole exposure is F = n 1ᵀC⁻¹d / 1ᵀC⁻¹1. With C = L D Lᵀ both products are
/// sums over the increments in their order, so a ramp that saturates after m of them has its own optimum at hand:
///   z_i = d_i + c_i z_{i-1},   numerator += a_i z_i,   F = n numerator / information(m).
/// What is common to all reads of a ramp (reset noise, offset of the pixel) is in no increment.
/// @source Brandt2024 for the likelihood; differs: the prefix sums, and weights from the expected charge, not from the
/// ramp itself, so that the fit is linear in the reads and unbiased. F90
class RampWeights {
 public:
  /// @param intervals  n >= 1.  @param photons_per_read_noise  φ >= 0; 0: least squares, infinite: last minus first.
  RampWeights(int intervals, double photons_per_read_noise);

  [[nodiscard]] int intervals() const { return static_cast<int>(carry_.size()); }
  /// c_i and a_i of increment i, 1 … n.
  [[nodiscard]] double carry(int i) const { return carry_[static_cast<std::size_t>(i) - 1]; }
  [[nodiscard]] double share(int i) const { return share_[static_cast<std::size_t>(i) - 1]; }
  /// 1ᵀC⁻¹1 of the first m increments, up to the factor that the numerator has too; m = 1 … n.
  [[nodiscard]] double information(int m) const { return information_[static_cast<std::size_t>(m) - 1]; }
  /// w_1 … w_m of F = Σ w_i d_i, from the first m increments; they add up to n. @accuracy 1e-13 relative
  [[nodiscard]] std::vector<double> weights(int m) const;
  /// Of F from the first m increments, whatever the charge: Σ w²/n and w_1² + Σ (w_i - w_{i+1})² + w_m².
  [[nodiscard]] RampVariance variance(int m) const;

 private:
  double coupling_;  // -off-diagonal / diagonal of the covariance, 0 … 1/2
  std::vector<double> carry_, share_, information_;
};

/// φ of a fit for a pixel that expects `electrons` in the exposure.
double photons_per_read_noise(RampFit fit, double electrons, int intervals, double read_variance);

/// Noise of a pixel that is read `reads` times in an exposure.
struct RampNoise {
  int reads = 1;  ///< 1: read once after a reset
  RampFit fit = RampFit::kOptimal;
  double full_well = std::numeric_limits<double>::infinity();  ///< e-; a fit uses the reads before it

  /// Increments whose reads are expected below the full well, 0 … reads - 1; 1 for a single read that is.
  [[nodiscard]] int usable_intervals(double electrons) const;
  /// Of the electrons that a pixel delivers. @param electrons  expected in the exposure, e-.
  /// @param read_variance  of one read, e-²: readout and quantisation noise.
  /// @valid  a fitted pixel with at least one usable increment; for others the variance of the first is stated.
  /// @source F90
  [[nodiscard]] RampVariance variance(double electrons, double read_variance) const;
};

}  // namespace astroid
