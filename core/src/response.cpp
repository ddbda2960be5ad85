#include "astroid/core/response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "astroid/core/error.hpp"

namespace astroid {

double ElectronicResponse::in(double output) const {
  // (1 + a1) I + a2 I² = output - a0. The root that tends to (output - a0) / (1 + a1) as a2 vanishes is the one where
  // the slope, which is the root of the discriminant, is positive.
  const double rest = output - a0;
  const double linear = 1.0 + a1;
  const double discriminant = linear * linear + 4.0 * (a2 * rest);
  return 2.0 * rest / (linear + std::sqrt(std::max(0.0, discriminant)));
}

ElectronicResponse make_response(std::span<const double> coefficients) {
  if (coefficients.empty()) return {};
  ASTROID_CHECK_EQ(coefficients.size(), std::size_t{3});
  return {.a0 = coefficients[0], .a1 = coefficients[1], .a2 = coefficients[2]};
}

void bend(const ElectronicResponse& response, double bias, std::span<double> values) {
  for (double& value : values) value = bias + response.out(value - bias);
}

void unbend(const ElectronicResponse& response, double bias, std::span<float> counts) {
  for (float& count : counts) count = static_cast<float>(bias + response.in(static_cast<double>(count) - bias));
}

}  // namespace astroid
