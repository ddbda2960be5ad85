// The weights that measure one star best where the light of others, and the background, are known only with doubt.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace astroid::detail {

/// What is known of the pixels of a window before the star in it is measured.
struct PsfWindow {
  std::span<const double> fractions;  ///< shape (pixels): of the target's flux, the PSF
  std::span<const double> variance;   ///< shape (pixels), e-²: expected noise of one exposure, all stars in it
  std::span<const double> doubts;     ///< shape (doubts, pixels), e-: each is light by whose one sigma we may be wrong
};

/// Errors of the flux in one exposure, e-; infinite where nothing can be measured.
struct PsfErrors {
  double noise = 0.0;  ///< of the pixels, under the weights
  double doubt = 0.0;  ///< of what is doubted: the same in every exposure
  double known = 0.0;  ///< noise of the best weights if nothing were in doubt
};

/// Memory that is kept from star to star.
struct PsfScratch {
  std::vector<double> inverse_sigma, star, residual, doubts, matrix, solution;
};

/// Best linear unbiased weights for the flux of one star: generalised least squares with priors.
///
/// data = flux p + sum_k f_k d_k + noise, f_k ~ N(0, 1), noise ~ N(0, V): w = C^-1 p / (p^T C^-1 p) with the covariance
/// C = V + sum_k d_k d_k^T. By Woodbury's identity only a matrix of the size of the doubts is solved: 1 + A A^T with
/// the rows a_k = d_k / sqrt(V), the normal equations scaled by their priors. Its eigenvalues are 1 or more, so the
/// Cholesky factorisation exists whatever coincides. Doubts that change no variance by more than 1e-4 are left out.
/// @param weights  [out] shape (pixels), 1; sum w p = 1, of any sign; all 0 if nothing of the star is in the window,
///                 or doubts inflate its error a million times.
/// @accuracy  1e-9 relative against the dense solution by GSL (test: PsfWeights.AreThoseOfTheDenseSolution).
/// @valid     any finite input with variance >= 0 (test: PsfWeights.AreFiniteHoweverManyStarsCoincide); a pixel without
/// variance has no light and no weight.
/// @complexity O(doubts² × (pixels + doubts))  @rng none  @thread safe with a scratch of its own
/// @source F48; Aitken1936; Stetson1987 for stars fitted together.
PsfErrors psf_weights(const PsfWindow& window, std::span<double> weights, PsfScratch& scratch);

}  // namespace astroid::detail
