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

/// The continuous Poisson quantile less floor(mean) + 1/2, for means that are not small. It decides the count where it
/// is less than `room` from an integer, its nearest: half a step less the bound on its error.
struct ContinuousCount {
  float offset;
  float room;
  bool in_range;  ///< of the fits
  float root;     ///< of the mean
  float tail;     ///< of normal_of_word()
};
ContinuousCount continuous_count(double mean, std::uint32_t word);

/// The Poisson count if the high word decides it in single precision, else poisson::kUndecided.
double poisson_of_word(double mean, std::uint32_t word);

}  // namespace astroid::reference
