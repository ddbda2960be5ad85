// The mean over a small motion as a sum over a few places.
#pragma once

#include <array>
#include <cstddef>

#include "astroid/core/geometry.hpp"

namespace astroid::detail {

struct MotionNode {
  PixelShift shift;
  double weight = 0.0;
};
inline constexpr std::size_t kMotionNodes = 5;

/// The centre, and sqrt(3) rms to either side along each principal axis: three-point Gauss-Hermite rules, exact to the
/// third order of the motion.
std::array<MotionNode, kMotionNodes> motion_nodes(const MotionCovariance& motion);

}  // namespace astroid::detail
