// Runs each main kernel once between two requests to callgrind, which counts its instructions (instructions.py).
//
// Unlike time, the number of instructions of a kernel is the same on a busy machine and on an idle one. The kernels run
// on AVX2, which processors and valgrind share, whatever else the processor has. What is counted is said on standard
// output as JSON.
#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/vector_target.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/psf_table.hpp"
#include "bench_scene.hpp"

namespace astroid {
namespace {

constexpr std::string_view kTarget = "AVX2";
constexpr int kCannotMeasure = 77;  // as CTest's SKIP_RETURN_CODE

constexpr int kSide = 256;  // px
constexpr std::size_t kPixels = std::size_t{kSide} * kSide;
constexpr std::uint32_t kSceneStars = 300;
constexpr int kStamps = 1000;
constexpr int kExposures = 2;

/// Runs `work` twice: to fill tables and caches, and to be counted.
/// @param unit, units  what the count is divided by, and how many of it `work` handles
void measure(const std::string& name, std::string_view unit, std::size_t units, const std::function<void()>& work) {
  work();
  CALLGRIND_START_INSTRUMENTATION;
  work();
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(name.c_str());
  static bool first = true;
  fmt::print("{}\n    {{\"name\": \"{}\", \"unit\": \"{}\", \"units\": {}}}", first ? "" : ",", name, unit, units);
  first = false;
}

void measure_noise() {
  const RandomStream stream = make_stream(1, StreamId{7}, 0, 0);
  const Rectangle area{0, 0, kSide, kSide};
  const PixelPlaces pixels{.areas = {&area, 1}};
  std::vector<std::uint32_t> words(kPixels);
  std::vector<float> normals(kPixels);
  std::vector<double> values(kPixels);
  measure("pixel_words", "pixel", kPixels, [&] { pixel_words(stream, pixels, words); });
  measure("pixel_normals", "pixel", kPixels, [&] { pixel_normals(stream, pixels, normals); });
  measure("add_pixel_normals", "pixel", kPixels, [&] { add_pixel_normals(stream, pixels, 25.0, values); });
  for (const double mean : {1.0, 60.0, 945.0}) {
    const std::vector<double> means(kPixels, mean);
    measure(fmt::format("pixel_poisson, mean {}", mean), "pixel", kPixels,
            [&] { pixel_poisson(stream, pixels, means, values); });
  }
  std::vector<std::uint8_t> flags(kPixels);
  constexpr double kTop = 65535.0;
  measure("digitise_pixels", "pixel", kPixels, [&] { digitise_pixels(values, kTop, normals, flags); });
}

void measure_maps() {
  constexpr std::size_t kMaps = 12;
  const std::vector<double> base(kPixels, 1.0);
  const std::vector<float> map(kPixels, 0.5F);
  const std::vector<const float*> maps(kMaps, map.data());
  const std::vector<float> weights(kMaps, 0.1F);
  std::vector<double> out(kPixels);
  measure("combine_maps, 12 maps", "pixel", kPixels, [&] { combine_maps(base, maps, weights, out); });
}

/// Stars that meet every sub-pixel phase, spread over an image.
void measure_stars(const std::string& name, const PixelPsf& psf) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr double kPlastic = 0.7548776662466927;
  constexpr double kLost = 1e-6;  // of a star's light outside its stamp
  std::vector<double> image(kPixels);
  std::vector<double> scratch;
  const ImageView<double, unit::ExpectedElectrons> view(image.data(), {0, 0, kSide, kSide}, kSide);
  const double half_width = psf.stamp_half_width(kLost);
  measure(name, "star", kStamps, [&] {
    for (int k = 0; k < kStamps; ++k)
      psf.add_star({.centre = {kSide * std::fmod(k * kGolden, 1.0), kSide * std::fmod(k * kPlastic, 1.0)},
                    .electrons = 1e4,
                    .half_width = half_width},
                   view, scratch);
  });
}

/// Exposures after the first, which is special where images are recalled.
void measure_exposures(const std::string& name, std::string_view unit, std::size_t units,
                       const bench::PlannedScene& planned) {
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  measure(name, unit, kExposures * units, [&] {
    for (int k = 1; k <= kExposures; ++k) simulator.simulate(k, exposure);
  });
}

bench::PlannedScene scene_of(Mission mission, const StarCatalogue& stars) {
  mission.simulation.exposures = EstimatorSet::kMaxBatch;
  return bench::plan_scene(mission, stars);
}

/// The same plan in which effects that are off do not exist: what they cost is the difference (instructions.py).
bench::PlannedScene without_what_is_off(const bench::PlannedScene& planned) {
  auto plan = std::make_shared<Plan>(*planned.plan);
  std::erase_if(plan->effects, [](const PlannedEffect& effect) { return !effect.need.needed; });
  return {planned.scene, plan};
}

void measure_sparse_scenes() {
  const StarCatalogue stars = bench::reference_stars(kSceneStars, kSide);
  const Mission reference = bench::reference_mission(kSide, bench::Detector::kReference);
  const bench::PlannedScene usual = scene_of(reference, stars);
  measure_exposures("reference exposure", "exposure", 1, usual);
  measure_exposures("reference exposure, no effect but those on", "exposure", 1, without_what_is_off(usual));
  Mission everything = bench::reference_mission(kSide, bench::Detector::kEverything);
  everything.ccd.full_well = Electrons(100000.0);  // so that some of these few stars bloom
  const bench::PlannedScene all = scene_of(everything, stars);
  if (!all.plan->runs("full-well")) throw BugError("no star of the scene blooms");
  measure_exposures("exposure with every effect", "exposure", 1, all);

  // The ten brightest stars are targets; the limit lies half way to the next.
  constexpr std::size_t kWindows = 10;
  std::vector<double> magnitudes;
  for (const CatalogueStar& star : stars.stars) magnitudes.push_back(star.magnitude.value());
  std::ranges::sort(magnitudes);
  Mission windows = reference;
  windows.ccd.window = 6;
  windows.photometry.target_limit = Magnitude(0.5 * (magnitudes[kWindows - 1] + magnitudes[kWindows]));
  const bench::PlannedScene windowed = scene_of(windows, stars);
  measure_exposures("window of 6 x 6 px", "window", windowed.scene->layout()->regions().size(), windowed);
}

/// Exposures recalled from maps, and photometry of every star: what a crowd is about.
void measure_crowd() {
  constexpr int kCrowdSide = 128;              // px
  constexpr std::uint32_t kCrowdStars = 2300;  // 14 in 100 px, as in the week of docs/performance.md
  const bench::PlannedScene crowd = scene_of(bench::reference_mission(kCrowdSide, bench::Detector::kReference),
                                             bench::reference_stars(kCrowdStars, kCrowdSide));
  if (crowd.plan->knobs.jitter != JitterTreatment::kPolynomial) throw BugError("the crowd is not recalled from maps");
  measure_exposures("exposure of a crowd", "exposure", 1, crowd);

  const Scene& scene = *crowd.scene;
  const Ground ground = perfect_ground(scene);
  const Simulator simulator(crowd.scene, crowd.plan, 0);
  std::vector<Frame> frames;
  for (std::size_t k = 0; k < EstimatorSet::kMaxBatch; ++k) {
    ExposureState exposure = simulator.make_state();
    simulator.simulate(static_cast<std::int64_t>(k), exposure);
    frames.push_back(std::move(exposure.frame));
  }
  for (const auto& [background, name] :
       {std::pair{BackgroundMethod::kKnown, "known"}, std::pair{BackgroundMethod::kLocal, "local"}}) {
    PhotometrySettings settings = scene.mission().photometry;
    settings.background = background;
    const EstimatorSet set(build_estimators(*scene.layout(), ground.model, settings), scene.mission().ccd.gain,
                           scene.mission().ccd.bias);
    std::vector<double> flux(set.size());
    std::vector<std::uint32_t> flags(set.size());
    measure(fmt::format("photometry, {} background", name), "star", set.size(),
            [&] { set.apply(frames.front(), flux, flags); });
    EstimatorSet::BatchScratch scratch;
    measure(fmt::format("photometry, {} background, {} frames at once", name, frames.size()), "star",
            frames.size() * set.size(), [&] {
              set.apply_batch(frames, scratch, [&flux](std::size_t star, std::span<const double> values, auto) {
                flux[star] = values[0];
              });
            });
  }
}

int measure_all() {
  const std::vector<std::string> targets = vector_targets();
  if (std::ranges::find(targets, kTarget) == targets.end()) {
    fmt::print(stderr, "instruction counts are of {}, which this processor does not have\n", kTarget);
    return kCannotMeasure;
  }
  force_vector_target(kTarget);
  fmt::print("{{\n  \"compiler\": \"g++ {}\",\n  \"vectors\": \"{}\",\n  \"kernels\": [", __VERSION__, vector_target());
  measure_noise();
  measure_maps();
  constexpr double kSigma = 0.65;  // px
  constexpr double kSamplesPerPixel = 16.0;
  constexpr double kHalfWidth = 5.0;  // px
  measure_stars("add_star, Gaussian", *make_gaussian_psf(kSigma));
  measure_stars("add_star, tabulated PSF",
                *make_prf_psf(test::gaussian_psf_table(kSigma, kSamplesPerPixel, kHalfWidth), 1e-6));
  measure_sparse_scenes();
  measure_crowd();
  fmt::print("\n  ]\n}}\n");
  return 0;
}

}  // namespace
}  // namespace astroid

int main() {
  return astroid::measure_all();
}
