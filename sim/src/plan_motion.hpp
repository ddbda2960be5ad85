// How the motion of the spacecraft enters the image.
#pragma once

#include <cstdint>

#include "astroid/sim/plan.hpp"

namespace astroid {

/// Chooses how motion enters the image so that what is neglected stays below its share of the brightest target's
/// tolerance.
void plan_jitter(const Scene& scene, double share, Plan& plan);

/// Replaces the rendering of every star by a polynomial in the attitude where that is cheaper. Like every decision,
/// this one looks at the whole detector, so windows and the full frame share it.
void plan_polynomial(const Scene& scene, double share, Plan& plan);

/// Lets the image be a polynomial in time too, over epochs much longer than those in which slow motion may be left out,
/// where that is cheaper.  @param longest  exposures in which all else is steady; 0: always
void plan_slow_motion(const Scene& scene, double share, std::int64_t longest, Plan& plan);

}  // namespace astroid
