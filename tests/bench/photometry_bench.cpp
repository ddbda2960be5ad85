// Time of photometry in a crowded field like the reference one: 32,240 stars on 480 × 480 px.
#include <benchmark/benchmark.h>

#include <cmath>

#include "astroid/photometry/background.hpp"
#include "astroid/photometry/calibration.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/photometry/reference_pixels.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr int kSide = 480;
constexpr std::uint32_t kStars = 32240;

// Star counts that grow 2.5-fold per magnitude down to P = 15, at random places.
const test::GroundScene& crowded_field() {
  static const test::GroundScene scene = [] {
    test::GroundScene s;
    s.psf = make_gaussian_psf(0.6);
    s.noise = {945.0, 50.2, 7.2};
    s.gain = Gain(25.0);
    const test::TestNoise noise(1);
    constexpr double kFaintest = 3717.0;  // e- in 21 s of a star of P = 15
    for (std::uint32_t i = 0; i < kStars; ++i)
      s.add_target({kSide * noise.uniform(0, i), kSide * noise.uniform(1, i)}, kFaintest / noise.uniform(2, i));
    return s;
  }();
  return scene;
}

PhotometrySettings settings_of(const benchmark::State& state) {
  PhotometrySettings settings;
  settings.method = static_cast<PhotometryMethod>(state.range(0));
  settings.background = static_cast<BackgroundMethod>(state.range(1));
  return settings;
}

void methods(benchmark::internal::Benchmark* b) {
  b->ArgNames({"method", "background"});
  for (const PhotometryMethod method :
       {PhotometryMethod::kAperture, PhotometryMethod::kMask, PhotometryMethod::kWeighted, PhotometryMethod::kPsf})
    for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal})
      b->Args({static_cast<long>(method), static_cast<long>(background)});
}

// Prescan, overscan and the light-sensitive pixels of the field.
const std::shared_ptr<const PixelLayout>& layout_with_reference_pixels() {
  static const auto layout = std::make_shared<const PixelLayout>(
      std::vector<Rectangle>{{0, 0, kSide, kSide}}, std::vector<Rectangle>{{-25, 0, 25, kSide}, {0, kSide, kSide, 30}});
  return layout;
}

Frame frame_with_noise() {
  Frame frame = test::empty_frame(layout_with_reference_pixels(), Gain(25.0), Adu(1000.0));
  const test::TestNoise noise(2);
  std::uint32_t i = 0;
  for (float& pixel : frame.pixels.pixels())
    pixel = static_cast<float>(std::nearbyint(1000.0 + 2.0 * noise.normal(0, i++)));
  return frame;
}

void BM_ColumnLevels(benchmark::State& state) {
  const Frame frame = frame_with_noise();
  const ReferenceNoise noise{.readout = 2.03, .gain = 25.0, .bias = 1000.0};
  std::vector<double> levels(kSide);
  for (auto _ : state) {
    column_levels(frame.pixels.view(2), noise, levels);
    benchmark::DoNotOptimize(levels.data());
  }
  state.SetItemsProcessed(state.iterations() * kSide * 30);
}
BENCHMARK(BM_ColumnLevels)->Unit(benchmark::kMicrosecond);

// What calibration takes of a frame: 0 smearing, 1 bias from the prescan, 2 the response of the electronics.
void BM_Calibrate(benchmark::State& state) {
  CalibrationModel model;
  model.detector = {0, 0, kSide, kSide};
  model.gain = Gain(25.0);
  model.bias = Adu(1000.0);
  model.readout_noise = Electrons(50.2);
  model.subtract_smearing = state.range(0) == 0;
  model.measure_bias = state.range(0) == 1;
  if (state.range(0) == 2) model.response = {.a0 = 0.0, .a1 = -0.0042789409, .a2 = 2.365e-7};
  const FrameCalibration calibration(*layout_with_reference_pixels(), model);
  Frame frame = frame_with_noise();
  FrameCalibration::Scratch scratch;
  for (auto _ : state) {
    calibration.apply(frame, scratch);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}
BENCHMARK(BM_Calibrate)->ArgName("what")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

void BM_BuildEstimators(benchmark::State& state) {
  const auto layout = test::full_frame(kSide, kSide);
  for (auto _ : state) benchmark::DoNotOptimize(build_estimators(*layout, crowded_field().model(), settings_of(state)));
  state.SetItemsProcessed(state.iterations() * kStars);
}
BENCHMARK(BM_BuildEstimators)->Apply(methods)->Unit(benchmark::kMillisecond);

void BM_ApplyEstimators(benchmark::State& state) {
  const auto layout = test::full_frame(kSide, kSide);
  const test::GroundScene& scene = crowded_field();
  const EstimatorSet set(build_estimators(*layout, scene.model(), settings_of(state)), scene.gain, scene.bias);
  Frame frame = test::empty_frame(layout, scene.gain, scene.bias);
  frame.flags.pixels()[0] = pixel_flag::kFullWell;  // a saturated star somewhere, as in any real field
  std::vector<double> flux(set.size());
  std::vector<std::uint32_t> flags(set.size());
  for (auto _ : state) {
    set.apply(frame, flux, flags);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kStars);
}
BENCHMARK(BM_ApplyEstimators)->Apply(methods)->Unit(benchmark::kMicrosecond);

/// The same by batches of `frames`; as in any real field a few hundred pixels around bright stars are saturated.
void BM_ApplyBatch(benchmark::State& state) {
  const auto layout = test::full_frame(kSide, kSide);
  const test::GroundScene& scene = crowded_field();
  PhotometrySettings settings;
  settings.background = static_cast<BackgroundMethod>(state.range(0));
  const EstimatorSet set(build_estimators(*layout, scene.model(), settings), scene.gain, scene.bias);
  std::vector<Frame> frames;
  for (std::int64_t f = 0; f < state.range(1); ++f) {
    frames.push_back(test::empty_frame(layout, scene.gain, scene.bias));
    for (std::size_t star = 0; star < static_cast<std::size_t>(state.range(2)); ++star)
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
          frames.back().flags.pixels()[(star * 2201 + row * kSide + column) % layout->size()] = pixel_flag::kFullWell;
  }
  EstimatorSet::BatchScratch scratch;
  double sum = 0.0;
  for (auto _ : state)
    set.apply_batch(frames, scratch, [&sum](std::size_t, std::span<const double> flux, std::span<const std::uint32_t>) {
      sum += flux[0];
    });
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * kStars * state.range(1));
}
BENCHMARK(BM_ApplyBatch)
    ->ArgNames({"background", "frames", "saturated stars"})
    ->ArgsProduct({{static_cast<long>(BackgroundMethod::kKnown), static_cast<long>(BackgroundMethod::kLocal)},
                   {4, 8, 16},
                   {0, 30}})
    ->Unit(benchmark::kMicrosecond);

void BM_BackgroundMesh(benchmark::State& state) {
  const auto layout = test::full_frame(1024, 1024);
  Frame frame = test::empty_frame(layout);
  const test::TestNoise noise(2);
  for (std::uint32_t i = 0; i < layout->size(); ++i)
    frame.pixels.pixels()[i] = static_cast<float>(1000.0 + 5.0 * noise.normal(0, i));
  for (auto _ : state) benchmark::DoNotOptimize(BackgroundMap(frame, 0, {}).median_level());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(layout->size()));
}
BENCHMARK(BM_BackgroundMesh)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace astroid
