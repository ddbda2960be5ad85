// What the difference of two PSFs of the same image does to its stars.
#pragma once

#include <cstddef>
#include <span>

#include "astroid/core/psf.hpp"
#include "field/field_solver.hpp"

namespace astroid::detail {

/// Typical |change| of a star's flux, relative, when it is fitted with `b` instead of `a`, its position free: that of a
/// normal distribution with the same median (its sigma when there is no mean).
/// @param stars  indices in field.stars()  @source F144
double flux_spread(const FieldSolver& field, std::span<const std::size_t> stars, const PixelPsf& a, const PixelPsf& b);

}  // namespace astroid::detail
