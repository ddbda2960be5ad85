// Horner's rule over a constant array, unrolled by the compiler.
#pragma once

#include <cstddef>

namespace astroid {

/// coefficient[0] + coefficient[1] x + ...
template <std::size_t N>
constexpr double polynomial(double x, const double (&coefficient)[N]) {
  double value = coefficient[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) value = value * x + coefficient[i];
  return value;
}

}  // namespace astroid
