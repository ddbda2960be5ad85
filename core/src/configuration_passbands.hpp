// The passbands a configuration may name.
#pragma once

#include <array>
#include <string_view>

namespace astroid::configuration {

/// Johnson-Cousins with near infrared, Tycho, Gaia, the Sloan bands, and the instrumental bands of PLATO (P),
/// TESS (T) and Kepler (Kp). Between which of them magnitudes can be converted is the catalogues' business.
inline constexpr std::array<std::string_view, 19> kPassbands = {"B",  "V",  "R", "I", "J", "H", "K", "B_T", "V_T", "G",
                                                                "BP", "RP", "g", "r", "i", "z", "P", "T",   "Kp"};

}  // namespace astroid::configuration
