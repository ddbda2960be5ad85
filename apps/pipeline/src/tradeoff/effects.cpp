#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/sim/simulator.hpp"
#include "target_sums.hpp"

namespace astroid::tradeoff {

namespace {

/// Without these there are no stars, or no numbers that mean electrons.
constexpr std::array<std::string_view, 6> kIndispensable = {"stars", "sub-pixel-stars", "gain", "pixel-gain", "bias",
                                                            "adc"};

constexpr std::int64_t kExposures = 4;

std::shared_ptr<const Plan> without(const Plan& plan, std::size_t effect) {
  auto changed = std::make_shared<Plan>(plan);
  changed->effects[effect].need.needed = false;
  return changed;
}

/// e- around each target in each exposure, as the frames say; NaN where a pixel is saturated.
std::vector<double> fluxes(const Simulator& simulator) {
  const Scene& scene = simulator.scene();
  const CcdSettings& ccd = scene.mission().ccd;
  ExposureState state = simulator.make_state();
  std::vector<double> sums;
  for (std::int64_t k = 0; k < std::min(kExposures, scene.mission().simulation.exposures); ++k) {
    simulator.simulate(k, state);
    const Frame& frame = state.frame;
    const auto electrons = [&](std::size_t region, int x, int y) {
      const bool full = (frame.flags.view(region).at(x, y) & (pixel_flag::kFullWell | pixel_flag::kAdcSaturated)) != 0;
      return full ? std::numeric_limits<double>::quiet_NaN()
                  : ccd.gain.value() * (static_cast<double>(frame.pixels.view(region).at(x, y)) - ccd.bias.value());
    };
    append_target_sums(scene, frame.pixels.layout(), electrons, sums);
  }
  return sums;
}

/// What an exposure of one takes more than one of the other: exposures in turns, since machines change their mind.
double seconds_saved(const Simulator& complete, const Simulator& without, double seconds) {
  constexpr std::size_t kFewest = 9;
  ExposureState one = complete.make_state();
  ExposureState other = without.make_state();
  const std::int64_t exposures = complete.scene().mission().simulation.exposures;
  std::vector<double> saved;
  double total = 0.0;
  for (std::int64_t k = 0; saved.size() < kFewest || total < 2.0 * seconds; ++k) {
    const double begin = cpu_seconds();
    complete.simulate(k % exposures, one);
    const double middle = cpu_seconds();
    without.simulate(k % exposures, other);
    const double end = cpu_seconds();
    saved.push_back(2.0 * middle - begin - end);
    total += end - begin;
  }
  return quantile(saved, 0.5).value;
}

}  // namespace

std::vector<TradeoffRow> sweep_effects(const PreparedGroup& run, double seconds) {
  const Simulator complete(run.scene, run.plan, 0);
  const std::vector<double> reference = fluxes(complete);
  const std::span<const std::size_t> targets = run.scene->targets();
  const double per_thousand = 1000.0 / static_cast<double>(std::max<std::size_t>(1, run.scene->stars().size()));
  std::vector<TradeoffRow> rows;
  for (std::size_t e = 0; e < run.plan->effects.size(); ++e) {
    const std::string name(run.plan->effects[e].effect->spec().name);
    if (!run.plan->effects[e].need.needed || std::ranges::find(kIndispensable, name) != kIndispensable.end()) continue;
    const Simulator simulator(run.scene, without(*run.plan, e), 0);
    const std::vector<double> sums = fluxes(simulator);
    TradeoffRow row{.sweep = Sweep::kEffect, .setting = "without " + name, .error_max = 0.0};
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (!std::isfinite(sums[i]) || !std::isfinite(reference[i])) continue;
      const double error = 1e6 * (sums[i] - reference[i]) / run.scene->stars()[targets[i % targets.size()]].electrons;
      squares += error * error;
      row.error_max = std::max(row.error_max, std::abs(error));
      count += 1.0;
    }
    row.error_rms = std::sqrt(squares / std::max(1.0, count));
    row.seconds = seconds_saved(complete, simulator, seconds) * per_thousand;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<TradeoffRow> sweep_series(const Mission& mission, double exposure_seconds, double seconds_once) {
  const double exposures_per_bin = std::max(1.0, std::floor(mission.analysis.bin / mission.simulation.cycle));
  const double own = std::floor(static_cast<double>(mission.simulation.exposures) / exposures_per_bin);
  std::vector<double> lengths;
  constexpr double kMostBins = 4096.0;
  for (double bins = 2.0; bins <= kMostBins; bins *= 2.0) lengths.push_back(bins);
  if (own >= 2.0 && std::ranges::find(lengths, own) == lengths.end()) lengths.push_back(own);
  std::ranges::sort(lengths);
  std::vector<TradeoffRow> rows;
  rows.reserve(lengths.size());
  for (const double bins : lengths)
    rows.push_back({.sweep = Sweep::kSeries,
                    .setting = fmt::format("{:g} bins", bins),
                    .parameter = fmt::format("Simulation/Exposures={:g}", bins * exposures_per_bin),
                    .value = bins,
                    .nsr_error = 1.0 / std::sqrt(2.0 * (bins - 1.0)),
                    .seconds_once = seconds_once + bins * exposures_per_bin * exposure_seconds,
                    .chosen = bins == own});
  return rows;
}

}  // namespace astroid::tradeoff
