// Decisions that several effects take in the same way.
#pragma once

#include <string_view>

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Need of a constant background of `level` e- per pixel and exposure: it biases an aperture by level x area and adds
/// as much variance.
EffectNeed background_need(const SceneSummary& scene, double level, std::string_view what);

}  // namespace astroid
