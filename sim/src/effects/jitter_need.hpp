// Whether pointing jitter matters: shared by the two ways of describing it.
#pragma once

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Compares what the motion does to the flux in a mask, to first order in variance (F25) and second order in the mean
/// (F26), with what the accuracy allows.
EffectNeed jitter_need(const SceneSummary& scene);

/// Points the spacecraft where the series says.
void take_attitude(ExposureState& state, const AttitudeSeries& series);

}  // namespace astroid
