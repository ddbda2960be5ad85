// Whether a slow displacement of the stars matters.
#pragma once

#include <string_view>

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Compares how far stars are displaced at most in the run, to second order in their flux in a mask, with the
/// tolerance.
EffectNeed displacement_need(const SceneSummary& scene, double displacement, std::string_view what);

}  // namespace astroid
