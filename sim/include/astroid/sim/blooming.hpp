// Blooming: what exceeds the full well spills along the column.
#pragma once

#include <cstdint>
#include <span>

#include "astroid/core/image.hpp"

namespace astroid {

/// Moves the charge above the full well along each column: half of every excess goes up, half down, each half fills the
/// free room it meets on its way, and what reaches the edge of the image is lost.
///
/// One sweep a direction, so O(pixels); charge is conserved: sum before = sum after + lost (rounding only). A column
/// without excess keeps its bits.
/// @param electrons  [in,out] after photon noise, e-.
/// @param full_well  e-, > 0. Afterwards no pixel is above it.
/// @param flags      [in,out] gains pixel_flag::kFullWell where a pixel was full, spilt charge or received some.
/// @returns  electrons lost through the edges. @complexity O(pixels) @rng none @thread safe
/// @source Jannsen2024; differs: one conserving sweep instead of repeated passes (test:
/// Blooming.ConservesChargeInAnyColumn).
double bloom(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
             const ImageView<std::uint8_t, unit::Flags>* flags = nullptr);

/// Clips at the full well without spilling; flags pixels that were full. @returns electrons removed.
double clip_full_well(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
                      const ImageView<std::uint8_t, unit::Flags>* flags = nullptr);

/// The same of pixels one after the other.
double clip_full_well(std::span<double> electrons, double full_well, std::span<std::uint8_t> flags);

}  // namespace astroid
