// Time of the reference exposure by stage: simulating it, each effect of it, measuring its stars, writing it.
//
// Times are CPU times of one thread, so that other programs on the machine disturb them little.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "astroid/photometry/estimator.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "bench_scene.hpp"
#include "image_files.hpp"

namespace astroid {
namespace {

using bench::Detector;
using bench::kReferenceSide;
using bench::kReferenceStars;
using bench::PlannedScene;
using bench::reference_mission;
using bench::reference_stars;

constexpr double kMilliseconds = 1e3;
constexpr double kNanoseconds = 1e9;
constexpr int kRepetitions = 5;  // docs/performance.md quotes the median of so many

PlannedScene reference_scene(Detector detector) {
  return bench::plan_scene(reference_mission(kReferenceSide, detector),
                           reference_stars(kReferenceStars, kReferenceSide));
}

/// CPU time of this thread by exposure, pixel and star. @param begin  thread_cpu_seconds() before the loop
void set_rates(benchmark::State& state, const Scene& scene, double begin) {
  const double seconds = (bench::thread_cpu_seconds() - begin) / static_cast<double>(state.iterations());
  state.counters["exposures/s"] = 1.0 / seconds;
  state.counters["ns/pixel"] = kNanoseconds * seconds / static_cast<double>(scene.layout()->size());
  state.counters["ns/star"] = kNanoseconds * seconds / static_cast<double>(scene.stars().size());
}

void simulate_exposures(benchmark::State& state, const PlannedScene& planned) {
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  const std::int64_t exposures = planned.scene->mission().simulation.exposures;
  std::int64_t number = 0;
  const double begin = bench::thread_cpu_seconds();
  for (auto _ : state) {
    simulator.simulate(number, exposure);
    number = (number + 1) % exposures;
    benchmark::ClobberMemory();
  }
  set_rates(state, *planned.scene, begin);
  state.counters["predicted ms"] = kMilliseconds * planned.plan->seconds_per_exposure;
}

// ---- The whole exposure, with effects on and off ----

struct Variant {
  std::string name;
  Detector detector;
  std::function<void(Mission&)> change;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> list = {
      {"reference", Detector::kReference, [](Mission&) {}},
      {"reference without jitter", Detector::kReference,
       [](Mission& m) { m.satellite.jitter.model = JitterModel::kNone; }},
      {"everything", Detector::kEverything, [](Mission&) {}},
      {"everything but jitter", Detector::kEverything,
       [](Mission& m) { m.satellite.jitter.model = JitterModel::kNone; }},
      {"everything but sky", Detector::kEverything, [](Mission& m) { m.field.sky_background = {}; }},
      {"everything but PRNU", Detector::kEverything, [](Mission& m) { m.ccd.prnu = 0.0; }},
      {"everything but dark current", Detector::kEverything, [](Mission& m) { m.ccd.dark_current = {}; }},
      {"everything but full well", Detector::kEverything, [](Mission& m) { m.ccd.full_well = Electrons(1e12); }},
      {"everything but readout noise", Detector::kEverything, [](Mission& m) { m.ccd.readout_noise = {}; }},
  };
  return list;
}

void BM_Exposure(benchmark::State& state) {
  const Variant& variant = variants()[static_cast<std::size_t>(state.range(0))];
  Mission mission = reference_mission(kReferenceSide, variant.detector);
  variant.change(mission);
  simulate_exposures(state, bench::plan_scene(mission, reference_stars(kReferenceStars, kReferenceSide)));
  state.SetLabel(variant.name);
}
BENCHMARK(BM_Exposure)
    ->DenseRange(0, 8)
    ->ArgName("variant")
    ->Unit(benchmark::kMillisecond)
    ->Repetitions(kRepetitions)
    ->ReportAggregatesOnly();

// Growth with stars and pixels.
void BM_Growth(benchmark::State& state) {
  const auto stars = static_cast<std::uint32_t>(state.range(0));
  const int side = static_cast<int>(state.range(1));
  simulate_exposures(state,
                     bench::plan_scene(reference_mission(side, Detector::kReference), reference_stars(stars, side)));
}
BENCHMARK(BM_Growth)
    ->ArgNames({"stars", "side"})
    ->ArgsProduct({{1, 1000, 20000, 80000}, {kReferenceSide}})
    ->ArgsProduct({{kReferenceStars}, {256, 512, 2048}})
    ->Unit(benchmark::kMillisecond);

// ---- Each effect ----

/// Median milliseconds of each effect over some exposures, as counters: CPU time between the ends of two effects.
void BM_Effects(benchmark::State& state) {
  const PlannedScene planned = reference_scene(static_cast<Detector>(state.range(0)));
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  constexpr int kExposures = 15;
  std::vector<std::string> names;
  std::vector<std::vector<double>> seconds;
  for (auto _ : state) {
    for (int k = 0; k < kExposures; ++k) {
      std::size_t effect = 0;
      double last = bench::thread_cpu_seconds();
      simulator.simulate(k, exposure, [&](const EffectSpec& spec, const ExposureState&) {
        const double now = bench::thread_cpu_seconds();
        if (effect == seconds.size()) {
          seconds.emplace_back();
          names.emplace_back(spec.name);
        }
        seconds[effect++].push_back(now - last);
        last = now;
      });
    }
  }
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const auto middle = seconds[i].begin() + static_cast<std::ptrdiff_t>(seconds[i].size() / 2);
    std::nth_element(seconds[i].begin(), middle, seconds[i].end());
    state.counters[names[i] + " ms"] = kMilliseconds * *middle;
  }
  state.SetLabel(static_cast<Detector>(state.range(0)) == Detector::kReference ? "reference" : "everything");
}
BENCHMARK(BM_Effects)->DenseRange(0, 1)->ArgName("variant")->Iterations(1)->Unit(benchmark::kMillisecond);

// ---- What comes after ----

void BM_MeasureAllStars(benchmark::State& state) {
  const PlannedScene planned = reference_scene(Detector::kReference);
  const Ground ground = perfect_ground(*planned.scene);
  PhotometrySettings settings = planned.scene->mission().photometry;
  settings.background = static_cast<BackgroundMethod>(state.range(0));
  const std::vector<StarEstimator> estimators = build_estimators(*planned.scene->layout(), ground.model, settings);
  const CcdSettings& ccd = planned.scene->mission().ccd;
  const EstimatorSet set(estimators, ccd.gain, ccd.bias);
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  simulator.simulate(0, exposure);
  std::vector<double> flux(set.size());
  std::vector<std::uint32_t> flags(set.size());
  const double begin = bench::thread_cpu_seconds();
  for (auto _ : state) {
    set.apply(exposure.frame, flux, flags);
    benchmark::ClobberMemory();
  }
  set_rates(state, *planned.scene, begin);
}
BENCHMARK(BM_MeasureAllStars)
    ->ArgName("background")
    ->Arg(static_cast<int>(BackgroundMethod::kKnown))
    ->Arg(static_cast<int>(BackgroundMethod::kLocal))
    ->Unit(benchmark::kMillisecond)
    ->Repetitions(kRepetitions)
    ->ReportAggregatesOnly();

void BM_BuildEstimatorsOfReference(benchmark::State& state) {
  const PlannedScene planned = reference_scene(Detector::kReference);
  const Ground ground = perfect_ground(*planned.scene);
  const double begin = bench::thread_cpu_seconds();
  for (auto _ : state)
    benchmark::DoNotOptimize(
        build_estimators(*planned.scene->layout(), ground.model, planned.scene->mission().photometry));
  set_rates(state, *planned.scene, begin);
}
BENCHMARK(BM_BuildEstimatorsOfReference)->Unit(benchmark::kMillisecond);

void BM_PlanReference(benchmark::State& state) {
  const StarCatalogue stars = reference_stars(kReferenceStars, kReferenceSide);
  const Mission mission = reference_mission(kReferenceSide, Detector::kReference);
  for (auto _ : state) benchmark::DoNotOptimize(bench::plan_scene(mission, stars));
}
BENCHMARK(BM_PlanReference)->Unit(benchmark::kMillisecond);

// 16-bit images, each in a file of its own as a run writes them, in the folder for temporary files. All stay until the
// last is written: a file system that has just lost hundreds of files is slow to make new ones.
void BM_WriteImage(benchmark::State& state) {
  static const test::TemporaryFolder folder;
  static std::int64_t number = 0;
  const PlannedScene planned = reference_scene(Detector::kReference);
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  simulator.simulate(0, exposure);
  const ImageFiles images(*planned.scene, *planned.plan, folder.path());
  const double begin = bench::thread_cpu_seconds();
  for (auto _ : state) {
    exposure.frame.header.exposure = number++;
    images.write(exposure.frame);
  }
  set_rates(state, *planned.scene, begin);
}
BENCHMARK(BM_WriteImage)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(100)
    ->Repetitions(kRepetitions)
    ->ReportAggregatesOnly();

}  // namespace
}  // namespace astroid
