// How the motion of the spacecraft enters the image.
#pragma once

#include "astroid/sim/plan.hpp"

namespace astroid {

/// Chooses how motion enters the image so that what is neglected stays below its share of the brightest target's
/// tolerance.
void plan_jitter(const Scene& scene, double share, Plan& plan);

/// Replaces the rendering of every star by a polynomial in the attitude where that is cheaper. Like every decision,
/// this one looks at the whole detector, so windows and the full frame share it.
void plan_polynomial(const Scene& scene, double share, Plan& plan);

}  // namespace astroid
