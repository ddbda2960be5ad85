#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "astroid/pipeline/calibrate.hpp"
#include "astroid/sim/simulator.hpp"
#include "target_sums.hpp"

namespace astroid::tradeoff {

namespace {

constexpr double kConverged = 0.001;  // ppm, the least that may be asked for
constexpr double kMillionth = 1e6;

struct Planned {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};

Planned planned(const Mission& mission, const StarCatalogue& catalogue, double ppm, int steps) {
  Mission changed = mission;
  changed.simulation.accuracy = Ppm(ppm);
  Planned p;
  p.scene = std::make_shared<const Scene>(changed, catalogue);
  p.plan = std::make_shared<const Plan>(make_plan(*p.scene, read_costs(costs_file()), steps));
  return p;
}

/// Spread over the run: the errors of some treatments of motion depend on where the spacecraft points.
std::vector<std::int64_t> exposures_of(const Mission& mission) {
  constexpr std::int64_t kMost = 9;
  const std::int64_t count = std::min(kMost, mission.simulation.exposures);
  std::vector<std::int64_t> exposures;
  for (std::int64_t i = 0; i < count; ++i)
    exposures.push_back(count > 1 ? i * (mission.simulation.exposures - 1) / (count - 1) : 0);
  return exposures;
}

/// Light around each target in each of the exposures, background included; NaN where it is not all on the layout.
std::vector<double> lights(const Simulator& simulator) {
  const Scene& scene = simulator.scene();
  ExposureState state = simulator.make_state();
  std::vector<double> sums;
  for (const std::int64_t exposure : exposures_of(scene.mission())) {
    simulator.expect(exposure, state);
    const auto& whole = std::as_const(state.expected).whole();
    append_target_sums(
        scene, whole.layout(), [&](std::size_t region, int x, int y) { return whole.view(region).at(x, y); }, sums);
  }
  return sums;
}

/// Additions to pixels when the image of the scene is made once.
double stamp_operations(const Planned& p) {
  constexpr double kTaps = 16.0;  // of a library's interpolation
  double sum = 0.0;
  for (const StampTier& tier : p.plan->knobs.stamps) {
    const double side = 2.0 * tier.half_width + 1.0;
    sum += static_cast<double>(tier.stars) * side * side;
  }
  return sum * (p.plan->renderer == "analytic" ? 1.0 : kTaps);
}

TradeoffRow measure(const Mission& mission, const StarCatalogue& catalogue, double ppm, int steps,
                    const std::vector<double>& reference, double seconds) {
  const double begin = cpu_seconds();
  const Planned p = planned(mission, catalogue, ppm, steps);
  const Simulator simulator(p.scene, p.plan, 0);
  const std::vector<double> sums = lights(simulator);
  TradeoffRow row{.sweep = Sweep::kAccuracy,
                  .setting = fmt::format("accuracy {:g} ppm", ppm),
                  .parameter = fmt::format("Simulation/Accuracy={:g}", ppm),
                  .value = ppm,
                  .error_max = 0.0,
                  .promised = ppm,
                  .of_promise = 0.0,
                  .seconds_once = cpu_seconds() - begin,
                  .memory = p.plan->memory_bytes / (1024.0 * 1024.0),
                  .operations = stamp_operations(p),
                  .chosen = ppm == mission.simulation.accuracy.value()};
  double squares = 0.0;
  double count = 0.0;
  const std::span<const std::size_t> targets = p.scene->targets();
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!std::isfinite(sums[i]) || !std::isfinite(reference[i])) continue;
    // Of the aperture, neighbours included, in which the star may be a small part: no less than the star's own share.
    constexpr double kPixels = kMaskSide * kMaskSide;
    const double own = p.scene->stars()[targets[i % targets.size()]].electrons;
    const double flux = std::max(own, reference[i] - kPixels * p.scene->summary().background);
    const double error = std::abs(sums[i] - reference[i]);
    squares += std::pow(kMillionth * error / flux, 2);
    row.error_max = std::max(row.error_max, kMillionth * error / flux);
    row.of_promise = std::max(row.of_promise, error / p.scene->summary().flux_tolerance(flux));
    count += 1.0;
  }
  row.error_rms = std::sqrt(squares / std::max(1.0, count));
  ExposureState state = simulator.make_state();
  std::int64_t exposure = 0;
  constexpr double kStars = 1000.0;
  row.seconds = median_seconds([&] { simulator.expect(exposure++ % mission.simulation.exposures, state); }, seconds) *
                kStars / static_cast<double>(std::max<std::size_t>(1, p.scene->stars().size()));
  return row;
}

}  // namespace

std::vector<TradeoffRow> sweep_accuracy(const Mission& mission, const StarCatalogue& catalogue, double seconds) {
  const Planned converged = planned(mission, catalogue, kConverged, 1);
  // All on the same path of the attitude, whose sampling is random and no systematic error.
  const int steps = converged.plan->knobs.attitude_steps;
  const std::vector<double> reference = lights(Simulator(converged.scene, converged.plan, 0));
  std::vector<double> asked{0.01, 0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0};
  const double own = mission.simulation.accuracy.value();
  if (std::ranges::find(asked, own) == asked.end() && own > kConverged) asked.push_back(own);
  std::ranges::sort(asked);
  std::vector<TradeoffRow> rows;
  rows.reserve(asked.size());
  for (const double ppm : asked) rows.push_back(measure(mission, catalogue, ppm, steps, reference, seconds));
  mark_pareto(rows);
  return rows;
}

}  // namespace astroid::tradeoff
