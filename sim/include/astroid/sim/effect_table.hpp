// The effects of a detector in the order of the run, checked when it is compiled.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "astroid/core/mission.hpp"
#include "astroid/sim/effect.hpp"

namespace astroid {

/// True when everything an effect reads was written by an effect before it (or is given), no stream number appears
/// twice, and levels never step back.
constexpr bool is_consistent(std::span<const EffectSpec> table) {
  std::uint32_t written = plane_bit::kStars | plane_bit::kFlags;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if ((table[i].reads & ~written) != 0) return false;
    if (i > 0 && table[i].level < table[i - 1].level) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (table[i].id == table[j].id || table[i].name == table[j].name) return false;
    written |= table[i].writes;
  }
  return true;
}

/// The effects of a detector type, in the order of the run.
const std::vector<std::unique_ptr<const Effect>>& effect_table(DetectorType type);

}  // namespace astroid
