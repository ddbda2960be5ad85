// Pieces of the scalar references that tests look at.
#pragma once

#include <cstdint>

namespace astroid::reference {

/// The normal quantile of a word and the share of the distribution beyond it, (1 - |2u - 1|) 2^31.
struct NormalOfWord {
  float z;
  float tail;
};
NormalOfWord normal_of_word(std::uint32_t word);

/// The continuous Poisson quantile less floor(mean), for means that are not small, with the bound on its error.
struct ContinuousCount {
  float offset;
  float bound;
  bool in_range;  ///< of the fits
  float root;     ///< of the mean
  float tail;     ///< of normal_of_word()
};
ContinuousCount continuous_count(double mean, std::uint32_t word);

/// The Poisson count if the high word decides it in single precision, else poisson::kUndecided.
double poisson_of_word(double mean, std::uint32_t word);

}  // namespace astroid::reference
