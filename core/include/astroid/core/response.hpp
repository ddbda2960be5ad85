// The response of readout electronics: a signal in, a slightly bent one out, and the way back.
#pragma once

#include <span>

namespace astroid {

/// Response of the electronics to a signal I above the bias, both in ADU: I + a0 + a1 I + a2 I².
///
/// @valid  where it rises: 1 + a1 + 2 a2 I > 0.  @source F33
struct ElectronicResponse {
  double a0 = 0.0;  ///< ADU
  double a1 = 0.0;
  double a2 = 0.0;  ///< 1/ADU
  [[nodiscard]] bool is_linear() const { return a0 == 0.0 && a1 == 0.0 && a2 == 0.0; }
  [[nodiscard]] double out(double signal) const { return signal + (a0 + (a1 + a2 * signal) * signal); }
  [[nodiscard]] double slope(double signal) const { return 1.0 + (a1 + 2.0 * a2 * signal); }
  /// Whether it rises over all signals from `lowest` to `highest`, so that it has an inverse there.
  [[nodiscard]] bool rises(double lowest, double highest) const { return slope(lowest) > 0.0 && slope(highest) > 0.0; }
  /// The signal on the rising branch that gives this output; an output beyond the extremum stands for the extremum.
  ///
  /// The root of the parabola in the form that does not cancel where a2 is small (or 0); exact, so that no iteration
  /// has to converge.
  /// @accuracy  4 units in the last place of the output (test: ElectronicResponse.InverseUndoesIt)
  [[nodiscard]] double in(double output) const;
  friend bool operator==(const ElectronicResponse&, const ElectronicResponse&) = default;
};

/// Of coefficients a0, a1, a2 as a configuration lists them; linear for none.
ElectronicResponse make_response(std::span<const double> coefficients);

/// values[i] = bias + out(values[i] - bias).  @complexity  O(values), 6 operations each
void bend(const ElectronicResponse& response, double bias, std::span<double> values);

/// counts[i] = bias + in(counts[i] - bias), in double and rounded to float at the end.
/// @complexity  O(counts), a root and a division each (bench: BM_Calibrate)
void unbend(const ElectronicResponse& response, double bias, std::span<float> counts);

}  // namespace astroid
