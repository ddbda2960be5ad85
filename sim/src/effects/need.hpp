// Decisions that several effects take in the same way.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "astroid/sim/effect.hpp"

namespace astroid {

/// Need of a constant background of `level` e- per pixel and exposure: it biases an aperture by level x area and adds
/// as much variance.
EffectNeed background_need(const SceneSummary& scene, double level, std::string_view what);

/// Need of a full well: whether any pixel of the noisiest exposure may reach it.
EffectNeed full_well_need(const SceneSummary& scene);

/// Need of independent noise of `rms` e- per pixel and exposure. @param what  of the number, in words.
EffectNeed noise_need(const SceneSummary& scene, double rms, std::string_view what);

/// What is the same in all reads of an exposure is in no difference between them: not needed, unless it may push a read
/// out of the ADC's range. Nothing where an exposure is read once. @param rms  e-.
std::optional<EffectNeed> common_to_reads(const SceneSummary& scene, double rms, const std::string& what);

/// Need of a fixed pattern of sensitivity of `rms`, relative: it changes fluxes by up to that, and more where stars
/// move.
EffectNeed response_need(const SceneSummary& scene, double rms, std::string_view what);

/// Need of what moves a share of the charge of any pixel to other pixels: no aperture changes by more than that share
/// of its pixels, were they all as full as the fullest, nor does its variance by more than twice the share.
EffectNeed moved_charge_need(const SceneSummary& scene, double share, std::string_view what);

}  // namespace astroid
