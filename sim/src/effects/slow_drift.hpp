// The slow change of the electronics, as with their temperature.
#pragma once

#include "astroid/core/math.hpp"
#include "astroid/core/mission.hpp"

namespace astroid {

/// Between -1 and 1 at a time since the start of the run: a pure function of time, the same for all cameras.
inline double slow_drift(Seconds time, const ElectronicsSettings& electronics) {
  constexpr double kTwoPi = 6.283185307179586;
  return det::sin(kTwoPi * (time / electronics.drift_period));
}

}  // namespace astroid
