// Decisions that several effects take in the same way.
#pragma once

#include <string_view>

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Need of a constant background of `level` e- per pixel and exposure: it biases an aperture by level x area and adds
/// as much variance.
EffectNeed background_need(const SceneSummary& scene, double level, std::string_view what);

/// Need of a fixed pattern of sensitivity of `rms`, relative: it changes fluxes by up to that, and more where stars
/// move.
EffectNeed response_need(const SceneSummary& scene, double rms, std::string_view what);

/// Need of what moves a share of the charge of any pixel to other pixels: no aperture changes by more than that share
/// of its pixels, were they all as full as the fullest, nor does its variance by more than twice the share.
EffectNeed moved_charge_need(const SceneSummary& scene, double share, std::string_view what);

}  // namespace astroid
