// What a plan costs, predicted before it runs.
#pragma once

#include <cstddef>

#include "astroid/sim/plan.hpp"

namespace astroid {

/// Fills in the time of each effect in one exposure of one camera on one core, and their sum; simulation only.
void predict_times(Plan& plan, const Scene& scene, const CostFactors& costs);

/// Time of rendering every star of the scene, and of summing the maps of a polynomial instead, over so many pixels.
double full_frame_seconds(const Plan& plan, const Scene& scene);
double maps_seconds(std::size_t terms, double pixels);
/// Memory of those maps.
double maps_bytes(std::size_t terms, double pixels);

/// Predicted memory of one worker's state, bytes.
double predicted_memory(const Plan& plan, const Scene& scene);

}  // namespace astroid
