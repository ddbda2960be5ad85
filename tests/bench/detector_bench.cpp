// Time that a full frame spends in the effects of the detector: whole frames, since they look beyond a strip.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/sim/brighter_fatter.hpp"
#include "astroid/sim/charge_transfer.hpp"
#include "astroid/sim/cosmic_rays.hpp"
#include "astroid/sim/power_law_field.hpp"

namespace astroid {
namespace {

constexpr int kSide = 4510;  // PLATO's CCD

/// A frame of background and stars.
Image<double, unit::SampledElectrons> frame() {
  Image<double, unit::SampledElectrons> image(kSide, kSide);
  std::size_t i = 0;
  for (double& pixel : image.pixels()) {
    pixel = i % 211 == 5 ? 3e4 : 900.0 + static_cast<double>(i % 61);
    ++i;
  }
  return image;
}

TransferChain rows_of(Image<double, unit::SampledElectrons>& image) {
  TransferChain chain{{}, static_cast<std::size_t>(image.nx()), 1};
  for (int y = 0; y < image.ny(); ++y) chain.packets.push_back(image.row(y).data());
  return chain;
}

void count_pixels(benchmark::State& state) {
  state.counters["time/pixel"] = benchmark::Counter(static_cast<double>(state.iterations()) * kSide * kSide,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);  // s
}

void BM_ChargeTransfer(benchmark::State& state, double loss) {
  auto image = frame();
  const TransferChain chain = rows_of(image);
  for (auto _ : state) benchmark::DoNotOptimize(transfer(chain, loss));
  count_pixels(state);
}
BENCHMARK_CAPTURE(BM_ChargeTransfer, loss_1e - 6, 1e-6)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ChargeTransfer, loss_1e - 4, 1e-4)->Unit(benchmark::kMillisecond);

void BM_Traps(benchmark::State& state) {
  auto image = frame();
  const TransferChain chain = rows_of(image);
  TrapModel model;
  model.dwell = Seconds(7.7e-4);
  for (int k = 0; k < state.range(0); ++k) model.species.push_back({1.0, 1e-21, Seconds(1e-3)});
  for (auto _ : state) benchmark::DoNotOptimize(transfer_through_traps(chain, model));
  count_pixels(state);
}
BENCHMARK(BM_Traps)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);

void BM_CosmicRays(benchmark::State& state) {
  auto image = frame();
  CosmicRayModel model;
  model.hits_per_pixel = 8.1e-4;  // 10 per cm² and second on 18 µm pixels in 25 s
  model.charge_location = 2500.0;
  model.charge_scale = 2000.0;
  model.charge_shape = 30.0;
  model.longest_track = 15.0;
  const RandomStream stream = make_stream(1, StreamId{51}, 0, 0);
  std::uint32_t exposure = 0;
  for (auto _ : state) benchmark::DoNotOptimize(add_cosmic_rays(model, stream, {exposure++}, image.view()));
  count_pixels(state);
}
BENCHMARK(BM_CosmicRays)->Unit(benchmark::kMillisecond);

void BM_BrighterFatter(benchmark::State& state) {
  auto image = frame();
  const BoundaryShifts shifts({4e-7, 6e-7, 0.5, static_cast<int>(state.range(0))});
  for (auto _ : state) benchmark::DoNotOptimize(brighter_fatter(image.view(), shifts));
  count_pixels(state);
}
BENCHMARK(BM_BrighterFatter)->Arg(2)->Arg(4)->Unit(benchmark::kMillisecond);

void BM_PowerLawField(benchmark::State& state) {
  const RandomStream stream = make_stream(1, StreamId{50}, 0, 0);
  for (auto _ : state) benchmark::DoNotOptimize(PowerLawField(stream, kSide, kSide, 1.0, 0.01).at(7, 7));
  count_pixels(state);
}
BENCHMARK(BM_PowerLawField)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace astroid
