// What can be a count of a detector.
#pragma once

#include <cmath>

namespace astroid::detail {

/// A number below 1e12: no detector counts so far, and the square of much more is no number of single precision.
inline bool is_count(float value) {
  constexpr float kLargest = 1e12F;
  return std::abs(value) < kLargest;  // false for what is not a number
}

}  // namespace astroid::detail
