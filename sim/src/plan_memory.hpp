// What the plan decides about detectors that remember, or look at each row at its own time.
#pragma once

#include "astroid/sim/plan.hpp"

namespace astroid {

/// Which exposures stand for the charge of others where it is released later, so that few images are kept: as few as
/// move no flux by more than a tenth of its tolerance, and no more than memory allows.
void plan_memory(const Scene& scene, Plan& plan);

/// Into how many bands the rows of a rolling shutter are put.
void plan_bands(const Scene& scene, Plan& plan);

/// Images of earlier exposures that are kept.
std::int64_t kept_images(const Plan& plan, const Scene& scene);

}  // namespace astroid
