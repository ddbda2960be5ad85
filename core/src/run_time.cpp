#include "astroid/core/run_time.hpp"

namespace astroid {

Seconds middle_of_run(const SimulationSettings& simulation) {
  return simulation.stagger + Seconds(0.5 * (static_cast<double>(simulation.exposures - 1) * simulation.cycle.value() +
                                             simulation.exposure_time.value()));
}

Seconds end_of_run(const SimulationSettings& simulation) {
  return simulation.stagger + Seconds(static_cast<double>(simulation.exposures - 1) * simulation.cycle.value() +
                                      simulation.exposure_time.value());
}

}  // namespace astroid
