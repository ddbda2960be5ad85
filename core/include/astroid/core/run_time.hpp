// When a run is half over, and when it ends.
#pragma once

#include "astroid/core/mission.hpp"

namespace astroid {

/// Middle of the run, since its start; of the cameras whose stagger the settings have.
Seconds middle_of_run(const SimulationSettings& simulation);
/// When the last exposure ends, likewise.
Seconds end_of_run(const SimulationSettings& simulation);

}  // namespace astroid
