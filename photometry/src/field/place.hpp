// Where a pixel of a stamp lies in memory.
#pragma once

#include <cstddef>

namespace astroid::detail {

/// Of column x in row y of an image with so many pixels in memory from row to row.
constexpr std::size_t place_in(int x, int y, int stride) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
}

}  // namespace astroid::detail
