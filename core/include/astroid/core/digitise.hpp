// Analogue-to-digital conversion of one value.
#pragma once

#include <cmath>
#include <cstdint>

#include "astroid/core/frame.hpp"

namespace astroid {

inline constexpr double kSqrt12 = 3.4641016151377545870548926830117447;

/// Largest count of an ADC. @param bits  1 … 24 (counts are exact in a float)
inline double adc_top(int bits) {
  return static_cast<double>((std::int64_t{1} << bits) - 1);
}

/// Clamps in double, then rounds half to even: an out-of-range double is never converted to an integer.
/// @param flag  [in,out] gains kAdcSaturated when clipped at either end, kBad when the value is not a number (count 0).
inline float digitise(double counts, double top, std::uint8_t& flag) {
  if (std::isnan(counts)) {
    flag |= pixel_flag::kBad;
    return 0.0F;
  }
  const double rounded = std::nearbyint(counts) + 0.0;  // -0 becomes 0, which not every rounding does by itself
  if (rounded >= top || rounded < 0.0) {
    // The top count itself stands for everything above it.
    flag |= pixel_flag::kAdcSaturated;
    return static_cast<float>(rounded < 0.0 ? 0.0 : top);
  }
  return static_cast<float>(rounded);
}

}  // namespace astroid
