#include "effects/throughput.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/throughput.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {
constexpr double kEpochShare = 0.1;  ///< of the tolerance, that the change within an epoch may take
}  // namespace

EffectNeed ThroughputEffect::is_needed(const SceneSummary& scene) const {
  const Mission& mission = *scene.mission;
  const SimulationSettings& simulation = mission.simulation;
  const Seconds length = static_cast<double>(simulation.exposures) * simulation.cycle;
  const double first = throughput_at(mission, Seconds(0.0));
  const double last = throughput_at(mission, length);
  const double worst = std::max(std::abs(1.0 - first), std::abs(1.0 - last));
  const double flux = scene.brightest_target_electrons;
  const double tolerance = flux > 0.0 ? scene.flux_tolerance(flux) / flux : scene.accuracy;
  EffectNeed need;
  need.needed = worst > tolerance;
  need.why =
      fmt::format("the optics pass {:.6g} of the light at the start and {:.6g} at the end of the run", first, last);
  need.bias_bound = worst * flux;
  // What changes slowly in an hour changes it alike in all cameras.
  const double change = std::abs(first - last) * std::min(1.0, mission.analysis.bin / length);
  need.variance_bound = flux > 0.0 ? change * change / scene.relative_variance_in_bin(flux) : 0.0;
  if (first != last) need.steady = Seconds(2.0 * kEpochShare * tolerance / std::abs(first - last) * length.value());
  return need;
}

void ThroughputEffect::set_conditions(const Scene& scene, Seconds time, Conditions& conditions) const {
  conditions.throughput *= throughput_at(scene.mission(), time);
}

void ThroughputEffect::apply(ExposureState& /*state*/, const EffectContext& /*context*/, const Strip& /*strip*/) const {
}

}  // namespace astroid
