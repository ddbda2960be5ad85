// The distortion of PLATO's normal cameras as PlatoSim 3 has it.
#pragma once

#include "astroid/core/distortion.hpp"
#include "astroid/core/units.hpp"

namespace astroid::test {

/// @source Jannsen2024's program, reference camera of 2026-06: 0.32419, 0.0232909, 0.407979 radial, 2.2463e-4 and
/// 2.17599e-4 thin prism, 3.81958e-4 and 9.63902e-4 tangential, in the form of Wang2008.
inline RadialTangential plato_distortion() {
  constexpr double kPrismX = 2.2463e-4;
  constexpr double kPrismY = 2.17599e-4;
  constexpr double kTangentialX = 3.81958e-4;
  constexpr double kTangentialY = 9.63902e-4;
  return {.k1 = 0.32419,
          .k2 = 0.0232909,
          .k3 = 0.407979,
          .p1 = 0.5 * kTangentialY,
          .p2 = 0.5 * kTangentialX,
          .s1 = kPrismX - 0.5 * kTangentialX,
          .s2 = kPrismY - 0.5 * kTangentialY};
}

/// Of 15 arcsec/px.
inline Pixels plato_focal_length() {
  return Pixels(206264.80624709636 / 15.0);
}

inline constexpr double kPlatoFieldRadius = 18.8908;  // deg

}  // namespace astroid::test
