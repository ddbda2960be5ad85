// The passbands a configuration may name.
#pragma once

#include <array>
#include <string_view>

namespace astroid::configuration {

/// Johnson-Cousins, Tycho, Gaia, and the instrumental bands of PLATO (P), TESS (T) and Kepler (Kp).
inline constexpr std::array<std::string_view, 13> kPassbands = {"B", "V",  "R",  "I", "J", "B_T", "V_T",
                                                                "G", "BP", "RP", "P", "T", "Kp"};

}  // namespace astroid::configuration
