// Charge that is moved along a detector: arithmetic on packets side by side, on the widest vectors of the processor
// (vector_target.hpp).
//
// Each kernel has a plain scalar twin in namespace reference, with the same bits. @thread safe, no state.
#pragma once

#include <span>

namespace astroid {

/// values[i] += factor * other[i].
void add_scaled(std::span<double> values, double factor, std::span<const double> other);

/// What one packet meets of one species of traps on its whole way to the register.
struct TrapPassage {
  double volume_power = 1.0;  ///< beta: the volume of a packet grows as its charge to this power, 0 .. 1
  double traps = 0.0;         ///< gamma: traps within reach of a packet of one electron
  double capture_rate = 0.0;  ///< alpha, at one electron: a packet of Q captures with 1 - exp(-alpha Q^(1-beta))
  double released = 0.0;      ///< share of the filled traps that empties before the next packet comes
};

/// Lets packets side by side pass one species of traps: captures, then releases.
///
/// captured = max(0, (gamma Q^beta - n) / (gamma Q^(beta-1) + 1)) (1 - exp(-alpha Q^(1-beta))), n the filled traps.
/// A packet of at most 1e-30 e- captures nothing. What a packet loses the traps gain, so charge + filled is conserved.
/// @param charge  [in,out] e-, never made negative.  @param filled  [in,out] traps that hold an electron.
/// @accuracy      of logarithm and exponentials: relative 1e-14 (test: TrapPassage.AgreesWithThePlainFormula).
/// @throws BugError when the spans differ in size.  @complexity some 90 operations a packet (bench: BM_Traps)
/// @source Short2013, Eqs. 22 and 23.
void pass_traps(const TrapPassage& passage, std::span<double> charge, std::span<double> filled);

/// The plain versions: what the kernels are tested against.
namespace reference {
void add_scaled(std::span<double> values, double factor, std::span<const double> other);
void pass_traps(const TrapPassage& passage, std::span<double> charge, std::span<double> filled);
}  // namespace reference

}  // namespace astroid
