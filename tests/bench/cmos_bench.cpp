// What a CMOS detector costs: a read of a ramp, inter-pixel capacitance, telegraph pixels, and a whole exposure.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/sim/inter_pixel_capacitance.hpp"
#include "astroid/sim/persistence.hpp"
#include "astroid/sim/ramp_fit.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/sim/telegraph.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

benchmark::Counter per_item(const benchmark::State& state, double items) {
  return {static_cast<double>(state.iterations()) * items, benchmark::Counter::kIsRate | benchmark::Counter::kInvert};
}

/// One read of one strip, weights of many charges.
void BM_RampRead(benchmark::State& state) {
  const RampLadder ladder(RampFit::kOptimal, 16, 170.0);
  std::vector<float> counts(kStripPixels);
  std::vector<float> previous(kStripPixels);
  std::vector<std::uint8_t> flags(kStripPixels);
  std::vector<std::uint8_t> levels(kStripPixels);
  std::vector<std::uint8_t> used(kStripPixels);
  std::vector<double> carried(kStripPixels);
  std::vector<double> numerator(kStripPixels);
  for (std::size_t i = 0; i < kStripPixels; ++i) {
    counts[i] = static_cast<float>(5000 + i % 997);
    levels[i] = ladder.level(static_cast<double>(i % 4999));
  }
  const RampPixels pixels{levels, previous, carried, numerator, used};
  for (auto _ : state) {
    take_ramp_read(ladder, 7, counts, flags, pixels);
    benchmark::ClobberMemory();
  }
  state.counters["time/pixel"] = per_item(state, kStripPixels);
}
BENCHMARK(BM_RampRead);

void BM_InterPixelCapacitance(benchmark::State& state) {
  constexpr int kSide = 512;
  Image<double, unit::SampledElectrons> charge(kSide, kSide);
  Image<double, unit::SampledElectrons> signal(kSide, kSide);
  std::ranges::fill(charge.pixels(), 1000.0);
  for (auto _ : state) {
    couple_pixels(charge.view(), {.side = 0.008, .corner = 0.001}, signal.view());
    benchmark::ClobberMemory();
  }
  state.counters["time/pixel"] = per_item(state, kSide * kSide);
}
BENCHMARK(BM_InterPixelCapacitance);

/// The state of one pixel that stays for 10, 100, … exposures.
void BM_Telegraph(benchmark::State& state) {
  const RandomStream stream = make_stream(1, StreamId{98}, 1, 0);
  const TelegraphProcess process{.renewal = 1.0 / static_cast<double>(state.range(0)), .high = 0.5};
  std::uint32_t step = 0;
  for (auto _ : state) benchmark::DoNotOptimize(telegraph_is_high(stream, {3, 5}, process, step++));
}
BENCHMARK(BM_Telegraph)->Arg(10)->Arg(100)->Arg(10000);

/// Strips of a frame that gain what as many earlier images release, and lose what is trapped.
void BM_Persistence(benchmark::State& state) {
  constexpr std::size_t kPixels = 512 * 512;
  const std::vector<std::vector<float>> past(static_cast<std::size_t>(state.range(0)),
                                             std::vector<float>(kPixels, 1000.0F));
  std::vector<double> strip(kStripPixels, 1000.0);
  for (auto _ : state)
    for (std::size_t begin = 0; begin < kPixels; begin += kStripPixels) {
      for (const std::vector<float>& image : past)
        add_released(std::span(image).subspan(begin, kStripPixels), 1e-4, strip);
      take_trapped(1e-3, Electrons(8e4), strip);
      benchmark::ClobberMemory();
    }
  state.counters["time/pixel"] = per_item(state, static_cast<double>(kPixels));
}
BENCHMARK(BM_Persistence)->Arg(0)->Arg(1)->Arg(8)->Arg(32);

/// 512 x 512 px with sky and a few stars; with neighbours coupled, a read of all pixels waits for the one before.
void BM_CmosExposure(benchmark::State& state) {
  Mission mission = test::bare_mission(512, 512);
  mission.simulation.type = DetectorType::kCmos;
  mission.field.sky_background = ElectronsPerSecond(45.0);
  mission.ccd.readout_noise = Electrons(13.0);
  mission.ccd.gain = Gain(1.92);
  mission.ccd.bias = Adu(5000.0);
  mission.ccd.adc_bits = 16;
  mission.ccd.full_well = Electrons(80000.0);
  mission.cmos.reads = static_cast<int>(state.range(0));
  mission.cmos.coupling = state.range(1) != 0 ? 0.008 : 0.0;
  const auto scene = std::make_shared<const Scene>(
      mission, test::lab_catalogue({{100.2, 90.1, 1e5}, {300.3, 200.7, 1e6}, {250.0, 400.2, 3e4}}));
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ExposureState exposure = simulator.make_state();
  std::int64_t number = 0;
  for (auto _ : state) simulator.simulate(number++ % 4, exposure);
  state.counters["time/pixel/read"] = per_item(state, 512.0 * 512.0 * static_cast<double>(state.range(0)));
}
BENCHMARK(BM_CmosExposure)
    ->ArgNames({"reads", "coupled"})
    ->ArgsProduct({{1, 4, 16}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace astroid
