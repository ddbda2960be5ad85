// A table of effects from a list of their types, checked when it is compiled.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "astroid/sim/effect_table.hpp"

namespace astroid {

/// The order of the run is the order of this list.
template <class... Effects>
struct EffectTable {
  static constexpr std::array<EffectSpec, sizeof...(Effects)> kSpecs{Effects::kSpec...};
  static_assert(is_consistent(kSpecs),
                "an effect reads a plane that nothing wrote, a stream number is used twice, or a level steps back");
  static std::vector<std::unique_ptr<const Effect>> make() {
    std::vector<std::unique_ptr<const Effect>> effects;
    (effects.push_back(std::make_unique<const Effects>()), ...);
    return effects;
  }
};

/// The effects of a CMOS detector; those of a CCD stand in the same file as effect_table().
const std::vector<std::unique_ptr<const Effect>>& cmos_effect_table();

}  // namespace astroid
