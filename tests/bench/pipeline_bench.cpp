// Time of the reference exposure by stage: simulating it, each effect of it, measuring its stars, writing it.
//
// Times are CPU times of one thread, so that other programs on the machine disturb them little; counters of exposures
// are medians.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/vector_target.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "bench_exposure.hpp"
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

constexpr int kRepetitions = 5;  // docs/performance.md quotes the median of so many

PlannedScene reference_scene(Detector detector) {
  return bench::plan_scene(reference_mission(kReferenceSide, detector),
                           reference_stars(kReferenceStars, kReferenceSide));
}

// ---- The whole exposure, with effects on and off ----

struct Variant {
  std::string name;
  Detector detector;
  std::function<void(Mission&)> change;
};

PlannedScene scene_of(const Variant& variant) {
  Mission mission = reference_mission(kReferenceSide, variant.detector);
  variant.change(mission);
  return bench::plan_scene(mission, reference_stars(kReferenceStars, kReferenceSide));
}

void stand_still(Mission& mission) {
  mission.satellite.jitter.model = JitterModel::kNone;
}

/// Everything between the expected image and the converter that a CCD may have.
void read_without_a_shutter(Mission& mission) {
  mission.ccd.reference = {.prescan = 25, .serial_overscan = 25, .parallel_overscan = 30};
  mission.ccd.smearing.model = SmearingModel::kOpenShutter;
  mission.ccd.nodes = {.count = 2, .gain_factor = {1.0, 1.02}, .noise_factor = {1.0, 1.1}, .cross_talk = 1e-4};
  mission.ccd.electronics.nonlinearity = {0.0, -0.0042789409, 2.365e-7};
  mission.ccd.electronics.gain_drift = 1e-4;
  mission.ccd.electronics.bias_drift = 2.0;
  mission.ccd.electronics.row_offset = 0.2;
  mission.ccd.electronics.pick_up = {.amplitude = 0.5, .column_frequency = 0.21, .row_frequency = 0.03};
  mission.ccd.bad_pixels = {.dead = 1e-4, .hot = 1e-4};
}

const std::vector<Variant>& scenes() {
  static const std::vector<Variant> list = {
      {"reference", Detector::kReference, [](Mission&) {}},
      {"everything", Detector::kEverything, [](Mission&) {}},
      {"static", Detector::kReference, stand_still},
      {"readout", Detector::kEverything, read_without_a_shutter},
  };
  return list;
}

/// On each instruction set that the processor has, the widest first.
void BM_Exposure(benchmark::State& state) {
  const Variant& variant = scenes()[static_cast<std::size_t>(state.range(0))];
  const std::vector<std::string> targets = vector_targets();
  const auto target = static_cast<std::size_t>(state.range(1));
  if (target >= targets.size()) {
    state.SkipWithError("the processor has no further instruction set");
    return;
  }
  force_vector_target(targets[target]);
  bench::simulate_exposures(state, scene_of(variant));
  force_vector_target({});
  state.SetLabel(variant.name + ", " + targets[target]);
}
BENCHMARK(BM_Exposure)
    ->ArgNames({"scene", "target"})
    ->ArgsProduct({{0, 1, 2}, {0, 1, 2, 3}})
    ->Unit(benchmark::kMillisecond)
    ->Repetitions(kRepetitions)
    ->ReportAggregatesOnly();

const std::vector<Variant>& ablations() {
  static const std::vector<Variant> list = {
      {"jitter", Detector::kEverything, stand_still},
      {"sky", Detector::kEverything, [](Mission& m) { m.field.sky_background = {}; }},
      {"PRNU", Detector::kEverything, [](Mission& m) { m.ccd.prnu = 0.0; }},
      {"dark current", Detector::kEverything, [](Mission& m) { m.ccd.dark_current = {}; }},
      {"full well", Detector::kEverything, [](Mission& m) { m.ccd.full_well = Electrons(1e12); }},
      {"blooming", Detector::kEverything, [](Mission& m) { m.ccd.blooming = false; }},
      {"readout noise", Detector::kEverything, [](Mission& m) { m.ccd.readout_noise = {}; }},
      {"bias", Detector::kEverything, [](Mission& m) { m.ccd.bias = {}; }},
  };
  return list;
}

/// What an exposure with everything saves when one effect is off: both in turn, so that a disturbance meets both.
void BM_EffectOff(benchmark::State& state) {
  const Variant& variant = ablations()[static_cast<std::size_t>(state.range(0))];
  const PlannedScene on = reference_scene(Detector::kEverything);
  const PlannedScene off = scene_of(variant);
  const Simulator simulator_on(on.scene, on.plan, 0);
  const Simulator simulator_off(off.scene, off.plan, 0);
  ExposureState exposure_on = simulator_on.make_state();
  ExposureState exposure_off = simulator_off.make_state();
  const std::int64_t exposures = on.scene->mission().simulation.exposures;
  std::vector<double> with;
  std::vector<double> without;
  std::vector<double> saved;
  std::int64_t number = 0;
  for (auto _ : state) {
    with.push_back(bench::cpu_milliseconds([&] { simulator_on.simulate(number, exposure_on); }));
    without.push_back(bench::cpu_milliseconds([&] { simulator_off.simulate(number, exposure_off); }));
    saved.push_back(with.back() - without.back());
    number = (number + 1) % exposures;
  }
  state.counters["with ms"] = bench::typical(with);
  state.counters["without ms"] = bench::typical(without);
  state.counters["saved ms"] = bench::median(saved);
  state.SetLabel(variant.name);
}
BENCHMARK(BM_EffectOff)->ArgName("effect")->DenseRange(0, 7)->Iterations(100)->Unit(benchmark::kMillisecond);

// ---- Each effect ----

/// Milliseconds of each effect over some exposures, as counters "<effect> ms": as the strips are made, wall
/// time. Clearing or recalling the noiseless image counts as the first effect of it, attitude and flags as "begin".
void BM_Effects(benchmark::State& state) {
  const Variant& variant = scenes()[static_cast<std::size_t>(state.range(0))];
  const PlannedScene planned = scene_of(variant);
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  const std::int64_t exposures = planned.scene->mission().simulation.exposures;
  std::vector<std::vector<double>> milliseconds(exposure.effect_seconds.size());
  std::int64_t number = 0;
  for (auto _ : state) {
    std::ranges::fill(exposure.effect_seconds, 0.0);
    simulator.simulate(number, exposure);
    number = (number + 1) % exposures;
    for (std::size_t i = 0; i < milliseconds.size(); ++i)
      milliseconds[i].push_back(bench::kMilliseconds * exposure.effect_seconds[i]);
  }
  for (std::size_t i = 0; i < milliseconds.size(); ++i)
    if (planned.plan->effects[i].need.needed)
      state.counters[std::string(planned.plan->effects[i].effect->spec().name) + " ms"] =
          bench::typical(milliseconds[i]);
  state.SetLabel(variant.name);
}
BENCHMARK(BM_Effects)->DenseRange(0, 3)->ArgName("scene")->Iterations(100)->Unit(benchmark::kMillisecond);

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
  std::vector<double> milliseconds;
  for (auto _ : state) milliseconds.push_back(bench::cpu_milliseconds([&] { set.apply(exposure.frame, flux, flags); }));
  bench::set_rates(state, *planned.scene, milliseconds);
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
  std::vector<double> milliseconds;
  for (auto _ : state)
    milliseconds.push_back(bench::cpu_milliseconds([&] {
      benchmark::DoNotOptimize(
          build_estimators(*planned.scene->layout(), ground.model, planned.scene->mission().photometry));
    }));
  bench::set_rates(state, *planned.scene, milliseconds);
}
BENCHMARK(BM_BuildEstimatorsOfReference)->Unit(benchmark::kMillisecond);

void BM_PlanReference(benchmark::State& state) {
  const StarCatalogue stars = reference_stars(kReferenceStars, kReferenceSide);
  const Mission mission = reference_mission(kReferenceSide, Detector::kReference);
  for (auto _ : state) benchmark::DoNotOptimize(bench::plan_scene(mission, stars));
}
BENCHMARK(BM_PlanReference)->Unit(benchmark::kMillisecond);

// A simulated exposure and its 16-bit image, in a file of its own as a run writes them, in the folder for temporary
// files. All stay until the last is written: a file system that has just lost hundreds of files is slow to make new
// ones. The counters "ms" and those with it are of writing alone; "simulated ms" is of what was written.
void BM_WriteImage(benchmark::State& state) {
  static const test::TemporaryFolder folder;
  static std::int64_t number = 0;
  const PlannedScene planned = reference_scene(Detector::kReference);
  const Simulator simulator(planned.scene, planned.plan, 0);
  const std::int64_t exposures = planned.scene->mission().simulation.exposures;
  ExposureState exposure = simulator.make_state();
  const ImageFiles images(*planned.scene, *planned.plan, folder.path());
  std::vector<double> simulated;
  std::vector<double> written;
  for (auto _ : state) {
    simulated.push_back(bench::cpu_milliseconds([&] { simulator.simulate(number % exposures, exposure); }));
    exposure.frame.header.exposure = number++;
    written.push_back(bench::cpu_milliseconds([&] { images.write(exposure.frame); }));
  }
  bench::set_rates(state, *planned.scene, written);
  state.counters["simulated ms"] = bench::typical(simulated);
}
BENCHMARK(BM_WriteImage)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(100)
    ->Repetitions(kRepetitions)
    ->ReportAggregatesOnly();

}  // namespace
}  // namespace astroid
