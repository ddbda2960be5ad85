// What a frame of the sub-pixel renderer costs: growth with sub-pixels, stars, pixels and cells; and what preparing it
// takes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "astroid/core/sub_pixel.hpp"

namespace astroid {
namespace {

std::vector<StarLight> stars_on(int side, std::int64_t count) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr double kPlastic = 0.7548776662466927;
  std::vector<StarLight> stars;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i + 1);
    stars.push_back(
        {.centre = {side * std::fmod(k * kGolden, 1.0), side * std::fmod(k * kPlastic, 1.0)}, .electrons = 1e4});
  }
  return stars;
}

FieldSpectrum everywhere(std::shared_ptr<const PsfSpectrum> spectrum) {
  return {.members = {std::move(spectrum)}, .weights = {}};
}

void render_frames(benchmark::State& state, int side, std::int64_t count, const SubPixelSettings& settings,
                   const FieldSpectrum& psf = everywhere(make_gaussian_spectrum(0.6))) {
  const Rectangle detector{0, 0, side, side};
  const SubPixelRenderer renderer(psf, detector, settings);
  const std::vector<StarLight> stars = stars_on(side, count);
  SubPixelRenderer::Workspace workspace;
  std::vector<double> light;
  while (state.KeepRunning()) {
    for (const Rectangle& tile : renderer.tiles()) {
      light.resize(tile.size() * static_cast<std::size_t>(renderer.cells() * renderer.cells()));
      renderer.render_cells(tile, stars, workspace, light);
      benchmark::DoNotOptimize(light.data());
      benchmark::ClobberMemory();
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(detector.size()));
  state.counters["nodes"] = static_cast<double>(renderer.map_size() * renderer.tiles().size());
  state.counters["tiles"] = static_cast<double>(renderer.tiles().size());
}

constexpr int kSide = 200;  // px

void BM_SubPixelGrowth(benchmark::State& state) {
  render_frames(state, kSide, 1, {.sub_pixels = static_cast<int>(state.range(0))});
}
BENCHMARK(BM_SubPixelGrowth)->Arg(2)->Arg(4)->Arg(8)->Arg(16)->Arg(32)->Unit(benchmark::kMillisecond);

void BM_SubPixelStars(benchmark::State& state) {
  render_frames(state, kSide, state.range(0), {.sub_pixels = 8});
}
BENCHMARK(BM_SubPixelStars)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

void BM_SubPixelFrame(benchmark::State& state) {
  render_frames(state, static_cast<int>(state.range(0)), 1000, {.sub_pixels = 4});
}
BENCHMARK(BM_SubPixelFrame)->Arg(100)->Arg(400)->Arg(1000)->Unit(benchmark::kMillisecond);

void BM_SubPixelCells(benchmark::State& state) {
  render_frames(state, kSide, 1000, {.sub_pixels = 4, .cells = static_cast<int>(state.range(0))});
}
BENCHMARK(BM_SubPixelCells)->Arg(1)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond);

/// 0 Moffat, 1 Airy, 2 Airy to 0.01 ppm, 3 four tables over the field.
struct Optics {
  FieldSpectrum psf;
  SubPixelSettings settings;
};

Optics optics(std::int64_t number) {
  if (number == 0) return {everywhere(make_moffat_spectrum(1.4, 2.5, {})), {.accuracy = 3e-7}};
  if (number == 1) return {everywhere(make_airy_spectrum(1.5, 0.3, {})), {.accuracy = 3e-7}};
  if (number == 2) return {everywhere(make_airy_spectrum(1.5, 0.3, {})), {.accuracy = 3e-9}};
  std::vector<FieldPsfTable> tables;
  for (const PixelPosition place :
       {PixelPosition{0.0, 0.0}, PixelPosition{kSide, 0.0}, PixelPosition{0.0, kSide}, PixelPosition{kSide, kSide}})
    tables.push_back({place, make_gaussian_table(0.6 + 1e-3 * (place.x + place.y), 1e-6)});
  return {make_field_spectrum(tables, Pixels(0.0)), {.accuracy = 3e-7}};
}

void BM_SubPixelOptics(benchmark::State& state) {
  const Optics o = optics(state.range(0));
  render_frames(state, kSide, 1000, o.settings, o.psf);
}
BENCHMARK(BM_SubPixelOptics)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

void BM_SubPixelPrepareOptics(benchmark::State& state) {
  while (state.KeepRunning()) {
    const Optics o = optics(state.range(0));
    const SubPixelRenderer renderer(o.psf, {0, 0, kSide, kSide}, o.settings);
    benchmark::DoNotOptimize(renderer.map_size());
  }
}
BENCHMARK(BM_SubPixelPrepareOptics)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

void BM_SubPixelPrepare(benchmark::State& state) {
  while (state.KeepRunning()) {
    const SubPixelRenderer renderer(make_gaussian_spectrum(0.6), {0, 0, kSide, kSide},
                                    {.sub_pixels = static_cast<int>(state.range(0))});
    benchmark::DoNotOptimize(renderer.map_size());
  }
}
BENCHMARK(BM_SubPixelPrepare)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace astroid
