// Random telegraph signal: a pixel that jumps between two states.
#pragma once

#include <cstdint>

#include "astroid/core/random.hpp"

namespace astroid {

/// Mean time that a pixel stays in each state, s.
struct TelegraphStays {
  double low = 1.0, high = 1.0;
};

/// A two-state Markov chain in steps, started long ago.
///
/// At each step the pixel forgets its state with the probability `renewal` and is then high with the probability
/// `high`; otherwise it stays. That is the chain with P(low → high) = renewal × high and P(high → low) = renewal ×
/// (1 - high); its autocorrelation is (1 - renewal)^lag. @source Machlup1954; F92
struct TelegraphProcess {
  double renewal = 1.0;  ///< 0 … 1
  double high = 0.5;     ///< share of time in the high state

  /// Of a process in continuous time that is seen every `step` seconds: exact for any step.
  static TelegraphProcess of_times(const TelegraphStays& stays, double step);
};

/// A pixel's chain.
struct TelegraphPixel {
  int x = 0, y = 0;
};

/// Whether the pixel is in its high state at a step: a pure function of the step, so a run that is longer, resumed or
/// split has the same states.
///
/// Renewals are looked for backwards from the step, in blocks of about 1 / renewal steps that begin at fixed steps; the
/// last renewal of a block takes one draw, so a state takes some three, however seldom the pixel jumps. Without any
/// renewal back to step 0 the state is that of the beginning.
/// @param step  0 … 2^32 - 1.  @param which  0 … 16383, tells several processes of a pixel apart.
/// @complexity O(1) (bench: BM_Telegraph)  @rng addresses (pixel, block)  @thread safe
bool telegraph_is_high(const RandomStream& stream, const TelegraphPixel& pixel, const TelegraphProcess& process,
                       std::uint32_t step);

}  // namespace astroid
