// How the stream of exposures grows: with their number (memory must not), and with threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "bench_exposure.hpp"
#include "bench_scene.hpp"

namespace astroid {
namespace {

using bench::Detector;

/// Wall and CPU time of a stream with photometry of every star and light curves on the disk.
void stream(benchmark::State& state, const Mission& mission, const StarCatalogue& stars, int threads) {
  const auto exposures = static_cast<double>(mission.simulation.exposures);
  const bench::PlannedScene planned = bench::plan_scene(mission, stars);
  const Ground ground = perfect_ground(*planned.scene);
  const std::vector<StarEstimator> estimators =
      build_estimators(*planned.scene->layout(), ground.model, mission.photometry);
  for (auto _ : state) {
    const test::TemporaryFolder folder;
    const double begin = bench::process_cpu_seconds();
    const StreamResult result = stream_exposures(planned.scene, planned.plan, estimators,
                                                 {.threads = threads, .folder = folder.path(), .progress = {}});
    state.counters["CPU ms"] = bench::kMilliseconds * (bench::process_cpu_seconds() - begin) / exposures;
    state.counters["wall ms"] = bench::kMilliseconds * result.timings.wall / exposures;
    state.counters["exposures/s"] = exposures / result.timings.wall;
  }
}

// ---- Exposures ----

/// Forgets the peak of the memory so far. @returns false where the system cannot
bool reset_peak_memory() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5";  // VmHWM begins anew
  file.close();
  return !file.fail();
}

/// MiB since the last reset, or since the start.
double peak_memory() {
  constexpr double kMebi = 1048576.0;
  constexpr double kKibi = 1024.0;
  std::ifstream file("/proc/self/status");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string name;
    double kibibytes = 0.0;
    if (words >> name >> kibibytes && name == "VmHWM:") return kibibytes / kKibi;
  }
  return peak_memory_bytes() / kMebi;
}

void BM_GrowthExposures(benchmark::State& state) {
  constexpr int kSide = 128;
  constexpr std::uint32_t kStars = 500;
  Mission mission = bench::reference_mission(kSide, Detector::kReference);
  mission.simulation.exposures = state.range(0);
  const bool fresh = reset_peak_memory();
  stream(state, mission, bench::reference_stars(kStars, kSide), 1);
  state.counters["peak MiB"] = peak_memory();
  if (!fresh) state.SetLabel("peak of all runs so far");
}
BENCHMARK(BM_GrowthExposures)
    ->ArgName("exposures")
    ->ArgsProduct({{50, 100, 200, 400, 800, 1600, 6400, 25600}})
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

// ---- Threads ----

// The best of some runs: on a shared machine the others measure the neighbours.
constexpr int kRepetitions = 3;
double smallest(const std::vector<double>& values) {
  return *std::ranges::min_element(values);
}

void BM_GrowthThreads(benchmark::State& state) {
  constexpr std::int64_t kExposures = 480;
  const bool week = state.range(0) != 0;
  Mission mission =
      week ? bench::week_mission(kExposures) : bench::reference_mission(bench::kReferenceSide, Detector::kReference);
  mission.simulation.exposures = kExposures;
  const StarCatalogue stars =
      week ? bench::week_stars(mission) : bench::reference_stars(bench::kReferenceStars, bench::kReferenceSide);
  stream(state, mission, stars, static_cast<int>(state.range(1)));
  state.SetLabel(week ? "week" : "reference");
}
BENCHMARK(BM_GrowthThreads)
    ->ArgNames({"week", "threads"})
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->Iterations(1)
    ->Repetitions(kRepetitions)
    ->ComputeStatistics("smallest", smallest)
    ->ReportAggregatesOnly()
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace astroid
