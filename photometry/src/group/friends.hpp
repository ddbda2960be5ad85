// Places that are near each other, as groups.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/geometry.hpp"

namespace astroid::detail {

/// Friends of friends within `distance`. Groups of more than `most` fall apart at ever shorter distances; what is still
/// larger at a thousandth of it is cut. Each group is in ascending order of indices, groups in that of their first.
std::vector<std::vector<std::size_t>> friends_of_friends(std::span<const PixelPosition> places, double distance,
                                                         std::size_t most);

}  // namespace astroid::detail
