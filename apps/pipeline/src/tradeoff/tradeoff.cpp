#include "astroid/pipeline/tradeoff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/product_folder.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "astroid/reports/tradeoff.hpp"
#include "astroid/sim/simulator.hpp"
#include "sweeps.hpp"

namespace astroid {

namespace {

constexpr double kMillionth = 1e6;
constexpr double kStars = 1000.0;  // that times are stated for
/// Errors below this share of the photon noise of one exposure of the brightest star cannot be seen in it.
constexpr double kUnseen = 0.1;

const TradeoffRow* chosen_of(const std::vector<TradeoffRow>& rows, Sweep sweep) {
  const auto row = std::ranges::find_if(rows, [&](const TradeoffRow& r) { return r.sweep == sweep && r.chosen; });
  return row != rows.end() ? &*row : nullptr;
}

std::string seconds_text(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", 1e6 * seconds);
  return seconds < 1.0 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

void advise_renderer(TradeoffResult& result) {
  const TradeoffRow* const own = chosen_of(result.rows, Sweep::kRenderer);
  const std::size_t fastest = knee(result.rows, Sweep::kRenderer, kUnseen * result.photon_noise);
  if (own == nullptr) return;
  result.advice.push_back(
      fmt::format("Renderer: {} errs by {:.2g} ppm rms and takes {} for 1000 stars; it is {} the Pareto front.",
                  own->setting, own->error_rms, seconds_text(own->seconds), own->pareto ? "on" : "not on"));
  if (fastest < result.rows.size())
    result.advice.push_back(fmt::format(
        "The knee, the fastest that errs by less than a tenth of the photon noise of the brightest target in an "
        "exposure ({:.3g} ppm), is {}: {:.2g} ppm, {}.",
        result.photon_noise, result.rows[fastest].setting, result.rows[fastest].error_rms,
        seconds_text(result.rows[fastest].seconds)));
}

/// @param images  of 1000 stars, that all exposures of the run amount to
void advise_accuracy(TradeoffResult& result, double images) {
  // What is an error in all cameras and exposures alike is to be compared with the noise that is left of them all.
  const double most = kUnseen * result.photon_noise_bin;
  const auto cost = [&](const TradeoffRow& row) { return row.seconds_once + images * row.seconds; };
  const TradeoffRow* const own = chosen_of(result.rows, Sweep::kAccuracy);
  const auto is_good = [&](const TradeoffRow& row) {
    return row.sweep == Sweep::kAccuracy && row.of_promise <= 1.0 && row.value <= most;
  };
  const TradeoffRow* best = own != nullptr && is_good(*own) ? own : nullptr;
  constexpr double kWorthIt = 0.9;  // of the time, or times cannot be told apart
  for (const TradeoffRow& row : result.rows)
    if (is_good(row) && (best == nullptr || cost(row) < kWorthIt * cost(*best))) best = &row;
  if (best == nullptr) return;
  result.advice.push_back(fmt::format(
      "Accuracy: the noise of a bin of all cameras is {:.3g} ppm for the brightest target, so errors below "
      "{:.2g} ppm do not show. Recommended: --set {} (measured {:.2g} ppm at most, {:.2g} of what is "
      "promised); the images of the run take {} of CPU.",
      result.photon_noise_bin, most, best->parameter, best->error_max, best->of_promise, seconds_text(cost(*best))));
  if (own != nullptr && own != best)
    result.advice.push_back(
        fmt::format("With the configuration's {:g} ppm they take {}.", own->value, seconds_text(cost(*own))));
}

void advise_photometry(TradeoffResult& result) {
  const TradeoffRow* best = nullptr;
  for (const TradeoffRow& row : result.rows)
    if (row.sweep == Sweep::kPhotometry && std::isfinite(row.noise_over_bound) &&
        (best == nullptr || row.noise_over_bound < 0.99 * best->noise_over_bound))
      best = &row;
  if (best != nullptr)
    result.advice.push_back(
        fmt::format("Photometry: the least noise has --set {}, {:.3f} of the bound for a star alone; half of its "
                    "targets are biased by "
                    "less than {:.2g} ppm.",
                    best->parameter, best->noise_over_bound, best->error_rms));
}

void advise_effects(TradeoffResult& result) {
  const TradeoffRow* dearest = nullptr;
  for (const TradeoffRow& row : result.rows)
    if (row.sweep == Sweep::kEffect && (dearest == nullptr || row.seconds > dearest->seconds)) dearest = &row;
  if (dearest != nullptr && dearest->seconds > 0.0)
    result.advice.push_back(
        fmt::format("Effects: {} saves most, {} an exposure for 1000 stars, and changes fluxes by {:.3g} ppm rms.",
                    dearest->setting, seconds_text(dearest->seconds), dearest->error_rms));
}

void advise_series(TradeoffResult& result) {
  for (const double error : {0.1, 0.03, 0.01}) {
    const auto row = std::ranges::find_if(
        result.rows, [&](const TradeoffRow& r) { return r.sweep == Sweep::kSeries && r.nsr_error <= error; });
    if (row == result.rows.end()) continue;
    result.advice.push_back(fmt::format(
        "Series: a star's noise to {:g} % takes --set {}, {} of CPU; `astroid budget` predicts it in milliseconds.",
        100.0 * error, row->parameter, seconds_text(row->seconds_once)));
  }
}

}  // namespace

TradeoffResult measure_tradeoff(const ResolvedConfiguration& configuration, const RunOptions& options,
                                const TradeoffOptions& tradeoff,
                                const std::function<void(const std::string&)>& progress) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto next = [&](const char* what) {
    if (progress) progress(what);
  };
  ProductFolder folder(options.folder, options.existing);
  const std::filesystem::path working = partial_path(folder.path());
  const StarCatalogue catalogue = load_field(configuration.mission);
  const PreparedRun run = prepare_run(configuration.mission, catalogue);
  const PreparedGroup& group = run.groups.front();
  const Mission& mission = group.scene->mission();
  const SceneSummary& summary = group.scene->summary();
  TradeoffResult result;
  result.photon_noise = kMillionth / std::sqrt(std::max(1.0, summary.brightest_target_electrons));
  result.photon_noise_bin = result.photon_noise / std::sqrt(summary.exposures_per_bin * summary.cameras);
  const auto append = [&](std::vector<TradeoffRow> rows) { std::ranges::move(rows, std::back_inserter(result.rows)); };
  next("renderers");
  append(tradeoff::sweep_renderers(group, tradeoff.seconds));
  next("accuracy of the scene");
  append(tradeoff::sweep_accuracy(mission, catalogue, tradeoff.seconds));
  next("methods of photometry");
  append(tradeoff::sweep_photometry(configuration, catalogue, tradeoff.exposures, options.threads));
  next("effects");
  append(tradeoff::sweep_effects(group, tradeoff.seconds));
  const double before = tradeoff::cpu_seconds();
  const Simulator simulator(group.scene, group.plan, 0);
  ExposureState state = simulator.make_state();
  const double once = tradeoff::cpu_seconds() - before;
  std::int64_t exposure = 0;
  const double each = tradeoff::median_seconds(
      [&] { simulator.simulate(exposure++ % mission.simulation.exposures, state); }, tradeoff.seconds);
  append(tradeoff::sweep_series(mission, each * configuration.mission.telescope.simulated_cameras, once));
  advise_renderer(result);
  advise_accuracy(result,
                  static_cast<double>(mission.simulation.exposures) * static_cast<double>(summary.stars) / kStars);
  advise_photometry(result);
  advise_effects(result);
  advise_series(result);
  write_text_file(working / "config.xml", to_xml(configuration));
  result.warnings = write_tradeoff(working, {.rows = result.rows,
                                             .photon_noise = result.photon_noise,
                                             .photon_noise_bin = result.photon_noise_bin,
                                             .advice = result.advice,
                                             .threads = options.threads});
  write_run_record(folder, {.command_line = options.command_line,
                            .threads = options.threads,
                            .run = &run,
                            .wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count(),
                            .warnings = result.warnings});
  folder.commit();
  return result;
}

}  // namespace astroid
