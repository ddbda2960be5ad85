// Which stars can reach which pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "astroid/sim/effect.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

enum class StarChoice : std::uint8_t { kAll, kConstant, kVariable };

/// For each area the stars whose stamps can touch it, in catalogue order.
/// @param farthest  the largest attitude of each axis, arcsec, in absolute value.
/// @complexity O(areas × stars nearby), through a grid of cells.
std::vector<std::vector<RenderedStar>> star_lists(const Scene& scene, const PlanKnobs& knobs,
                                                  std::span<const Rectangle> areas, const Attitude& farthest,
                                                  StarChoice choice = StarChoice::kAll);

/// How far the attitude leads the images that are made, arcsec: those that a polynomial goes through lie up to a cell
/// farther out than any exposure.
Attitude farthest_attitude(const PrepareContext& context);

/// The same for the areas of each strip: [strip][area].
std::vector<std::vector<std::vector<RenderedStar>>> star_lists(const PrepareContext& context,
                                                               std::span<const Strip> strips, StarChoice choice);

}  // namespace astroid
