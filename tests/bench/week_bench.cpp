// The preset plato-week: 24,192 exposures of 32,240 stars on 480 × 480 px, photometry of every star.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "astroid/core/worker_pool.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "bench_scene.hpp"

namespace astroid {
namespace {

constexpr std::int64_t kExposures = 500;

/// Streams 500 exposures on `threads` threads (0: all cores), light curves to disc, and extrapolates to the week.
///
/// "week min" is wall time as the machine was; "week CPU min" what as many idle cores would need if the work divided
/// evenly. Both count what is done once only once.
void BM_Week(benchmark::State& state) {
  const int threads = state.range(0) > 0 ? static_cast<int>(state.range(0)) : available_threads();
  const Mission mission = bench::week_mission(kExposures);
  constexpr double kSecondsPerMinute = 60.0;
  constexpr double kScale = static_cast<double>(bench::kWeekExposures) / static_cast<double>(kExposures);
  constexpr double kMilliseconds = 1e3;
  for (auto _ : state) {
    const double cpu_begin = bench::process_cpu_seconds();
    const StarCatalogue stars = bench::week_stars(mission);
    const bench::PlannedScene planned = bench::plan_scene(mission, stars);
    const double cpu_planned = bench::process_cpu_seconds();
    const Ground ground = perfect_ground(*planned.scene);
    const std::vector<StarEstimator> estimators =
        build_estimators(*planned.scene->layout(), ground.model, mission.photometry);
    const double cpu_built = bench::process_cpu_seconds();
    const test::TemporaryFolder folder;
    const StreamResult result = stream_exposures(planned.scene, planned.plan, estimators,
                                                 {.threads = threads, .folder = folder.path(), .progress = {}});
    const double cpu_stream = bench::process_cpu_seconds() - cpu_built;
    const double once = cpu_built - cpu_begin;
    const auto per_exposure = [](double seconds) { return kMilliseconds * seconds / static_cast<double>(kExposures); };
    state.counters["threads"] = threads;
    state.counters["targets"] = static_cast<double>(estimators.size());
    state.counters["catalogue and plan s"] = cpu_planned - cpu_begin;
    state.counters["estimators s"] = cpu_built - cpu_planned;
    state.counters["prepare s"] = result.timings.prepare;
    state.counters["exposure CPU ms"] = per_exposure(cpu_stream);
    state.counters["simulate ms"] = per_exposure(result.timings.simulate);
    state.counters["measure ms"] = per_exposure(result.timings.measure);
    state.counters["statistics ms"] = per_exposure(result.timings.statistics);
    state.counters["light curves ms"] = per_exposure(result.timings.light_curves);
    state.counters["predicted ms"] = kMilliseconds * planned.plan->seconds_per_exposure;
    for (const auto& [effect, seconds] : result.effect_seconds) state.counters[effect + " ms"] = per_exposure(seconds);
    state.counters["week CPU min"] = (once + kScale * cpu_stream / threads) / kSecondsPerMinute;
    state.counters["week min"] = (once + kScale * result.timings.wall) / kSecondsPerMinute;
  }
}
BENCHMARK(BM_Week)->ArgName("threads")->Arg(1)->Arg(0)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(
    benchmark::kSecond);

}  // namespace
}  // namespace astroid
