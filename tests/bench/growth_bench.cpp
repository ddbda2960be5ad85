// How the time of an exposure grows: with pixels, stars, the size of the PSF, the steps of the jitter, and windows.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/fits_writer.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "bench_exposure.hpp"
#include "bench_scene.hpp"

namespace astroid {
namespace {

using bench::Detector;
using bench::kReferenceSide;
using bench::kReferenceStars;
using bench::plan_scene;
using bench::PlannedScene;
using bench::reference_mission;
using bench::reference_stars;
using bench::simulate_exposures;

void BM_GrowthStars(benchmark::State& state) {
  simulate_exposures(state, plan_scene(reference_mission(kReferenceSide, Detector::kReference),
                                       reference_stars(static_cast<std::uint32_t>(state.range(0)), kReferenceSide)));
}
BENCHMARK(BM_GrowthStars)
    ->ArgName("stars")
    ->ArgsProduct({{1, 300, 1000, 3000, 5000, 10000, 20000, 40000, 80000}})
    ->Unit(benchmark::kMillisecond);

/// With as many stars per pixel as the reference exposure.
void BM_GrowthPixels(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const auto stars = static_cast<std::uint32_t>(std::int64_t{kReferenceStars} * side * side /
                                                (std::int64_t{kReferenceSide} * kReferenceSide));
  simulate_exposures(state, plan_scene(reference_mission(side, Detector::kReference), reference_stars(stars, side)));
}
BENCHMARK(BM_GrowthPixels)->ArgName("side")->ArgsProduct({{256, 512, 1024, 2048, 4096}})->Unit(benchmark::kMillisecond);

// ---- The PSF ----

double mean_stamp_side(const PlannedScene& planned) {
  double sum = 0.0;
  for (const SceneStar& star : planned.scene->stars())
    sum += 2.0 * planned.plan->knobs.stamp_half_width(star.electrons) + 1.0;
  return sum / static_cast<double>(planned.scene->stars().size());
}

/// Gaussian; @param sigma  hundredths of a pixel
void BM_GrowthGaussian(benchmark::State& state) {
  Mission mission = reference_mission(kReferenceSide, Detector::kReference);
  constexpr double kHundredth = 0.01;
  mission.psf.sigma = Pixels(kHundredth * static_cast<double>(state.range(0)));
  const PlannedScene planned = plan_scene(mission, reference_stars(kReferenceStars, kReferenceSide));
  simulate_exposures(state, planned);
  state.counters["sigma px"] = mission.psf.sigma.value();
  state.counters["stamp px"] = mean_stamp_side(planned);
  state.SetLabel(std::string(to_string(planned.plan->knobs.jitter)));
}
BENCHMARK(BM_GrowthGaussian)
    ->ArgName("sigma")
    ->ArgsProduct({{30, 50, 65, 100, 150, 200, 300}})
    ->Unit(benchmark::kMillisecond);

/// A table of a Moffat profile with wings. @param half_width  of the table, px
std::string write_table(const test::TemporaryFolder& folder, int half_width) {
  constexpr int kSamplesPerPixel = 8;
  const int side = 2 * half_width * kSamplesPerPixel;
  const double centre = 0.5 * (side - 1);
  std::vector<double> samples;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double r = std::hypot(x - centre, y - centre) / kSamplesPerPixel;
      samples.push_back(std::pow(1.0 + r * r, -2.5));
    }
  const std::string path = (folder.path() / ("moffat" + std::to_string(half_width) + ".fits")).string();
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat64, {side, side});
  writer.card({"SUBPIX", kSamplesPerPixel});
  writer.write_pixels(0, std::span<const double>(samples));
  writer.commit();
  return path;
}

void BM_GrowthTable(benchmark::State& state) {
  static const test::TemporaryFolder folder;
  Mission mission = reference_mission(kReferenceSide, Detector::kReference);
  mission.psf.model = PsfModel::kTable;
  mission.psf.file = write_table(folder, static_cast<int>(state.range(0)));
  const PlannedScene planned = plan_scene(mission, reference_stars(kReferenceStars, kReferenceSide));
  simulate_exposures(state, planned);
  state.counters["stamp px"] = mean_stamp_side(planned);
  state.SetLabel(std::string(to_string(planned.plan->knobs.jitter)));
}
BENCHMARK(BM_GrowthTable)->ArgName("half-width")->Arg(3)->Arg(5)->Arg(8)->Arg(12)->Unit(benchmark::kMillisecond);

// ---- Jitter ----

/// All products of powers up to `degree` in all.
std::vector<AttitudePowers> terms_up_to(int degree) {
  std::vector<AttitudePowers> terms;
  for (int total = 0; total <= degree; ++total)
    for (int yaw = total; yaw >= 0; --yaw)
      for (int pitch = total - yaw; pitch >= 0; --pitch) terms.push_back({yaw, pitch, total - yaw - pitch});
  return terms;
}

/// The plan of a scene with its motion treated otherwise. @param amount  steps, or the degree of the polynomial
PlannedScene with_jitter(const PlannedScene& planned, JitterTreatment treatment, int amount) {
  Plan plan = *planned.plan;
  plan.knobs.jitter = treatment;
  plan.knobs.polynomial = {};
  if (treatment == JitterTreatment::kSubSteps) plan.knobs.attitude_steps = amount;
  if (treatment == JitterTreatment::kPolynomial) {
    constexpr double kReach = 4.5;  // rms of the motion, as plans have it
    const AttitudeVariance variance = planned.scene->attitude().variance();
    plan.knobs.polynomial.terms = terms_up_to(amount);
    plan.knobs.polynomial.scale = {kReach * std::sqrt(variance.yaw), kReach * std::sqrt(variance.pitch),
                                   kReach * std::sqrt(variance.roll)};
  }
  return {.scene = planned.scene, .plan = std::make_shared<const Plan>(std::move(plan))};
}

PlannedScene jitter_scene(bool crowded) {
  if (!crowded)
    return plan_scene(reference_mission(kReferenceSide, Detector::kReference),
                      reference_stars(kReferenceStars, kReferenceSide));
  const Mission mission = bench::week_mission(4);
  return plan_scene(mission, bench::week_stars(mission));
}

/// The reference scene, or the crowd of the week, with a treatment that the plan need not have chosen.
void BM_GrowthJitter(benchmark::State& state) {
  const bool crowded = state.range(0) != 0;
  const auto treatment = static_cast<JitterTreatment>(state.range(1));
  const PlannedScene planned = with_jitter(jitter_scene(crowded), treatment, static_cast<int>(state.range(2)));
  simulate_exposures(state, planned);
  state.counters.erase("predicted ms");  // of another treatment
  state.SetLabel(std::string(crowded ? "crowded, " : "sparse, ") + std::string(to_string(treatment)));
}
void jitter_treatments(benchmark::internal::Benchmark* b) {
  b->ArgNames({"crowded", "treatment", "amount"});
  for (const std::int64_t crowded : {0, 1}) {
    b->Args({crowded, static_cast<long>(JitterTreatment::kShift), 1});
    b->Args({crowded, static_cast<long>(JitterTreatment::kBroadened), 1});
    for (const std::int64_t steps : {1, 2, 4, 10, 30, 100})
      b->Args({crowded, static_cast<long>(JitterTreatment::kSubSteps), steps});
    for (const std::int64_t degree : {1, 2, 3})
      b->Args({crowded, static_cast<long>(JitterTreatment::kPolynomial), degree});
  }
}
BENCHMARK(BM_GrowthJitter)->Apply(jitter_treatments)->Unit(benchmark::kMillisecond);

// ---- Windows ----

/// The magnitude that so many stars are brighter than.
Magnitude limit_of(const StarCatalogue& catalogue, std::size_t stars) {
  std::vector<double> magnitudes;
  for (const CatalogueStar& star : catalogue.stars) magnitudes.push_back(star.magnitude.value());
  std::ranges::sort(magnitudes);
  return Magnitude(0.5 * (magnitudes[stars - 1] + magnitudes[stars]));
}

/// Windows around the brightest stars of the reference scene; a side of 0 is the full frame with the same targets.
void BM_Windows(benchmark::State& state) {
  const StarCatalogue catalogue = reference_stars(kReferenceStars, kReferenceSide);
  Mission mission = reference_mission(kReferenceSide, Detector::kReference);
  mission.photometry.target_limit = limit_of(catalogue, static_cast<std::size_t>(state.range(0)));
  mission.ccd.window = static_cast<int>(state.range(1));
  const PlannedScene planned = plan_scene(mission, catalogue);
  simulate_exposures(state, planned);
  state.counters["pixels"] = static_cast<double>(planned.scene->layout()->size());
  state.counters["windows"] = static_cast<double>(planned.scene->layout()->regions().size());
}
BENCHMARK(BM_Windows)
    ->ArgNames({"targets", "window"})
    ->ArgsProduct({{100, 1000, 3000}, {0, 6, 12}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace astroid
