// Ten million exposures, eight years of them: times, deviations and sums keep a signal of 0.01 ppm (hard cases N14,
// N15, N30 and N31).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "astroid/core/statistics/sums.hpp"

namespace astroid {
namespace {

constexpr std::int64_t kExposures = 10'000'000;
constexpr double kCycle = 25.0;        // s
constexpr double kAmplitude = 1e-8;    // 0.01 ppm
constexpr double kFrequency = 3.1e-4;  // Hz
constexpr double kFlux = 148017.3;     // e- per exposure

double phase(std::int64_t exposure) {
  const double time = static_cast<double>(exposure) * kCycle;  // exact: no sum of cycles
  return 2.0 * M_PI * std::fmod(kFrequency * time, 1.0);
}

TEST(LongSeries, KeepsASinusoidOfAHundredthOfAPpm) {
  CompensatedSum sine;
  CompensatedSum cosine;
  RunningMoments fluxes;
  for (std::int64_t k = 0; k < kExposures; ++k) {
    const double flux = kFlux * (1.0 + kAmplitude * std::sin(phase(k)));
    fluxes.add(flux);
    // As light curves store it: the deviation from a reference in single precision, never the flux.
    const auto deviation = static_cast<double>(static_cast<float>(flux / kFlux - 1.0));
    sine.add(deviation * std::sin(phase(k)));
    cosine.add(deviation * std::cos(phase(k)));
  }
  const double amplitude = 2.0 / static_cast<double>(kExposures) * std::hypot(sine.value(), cosine.value());
  const double rms = fluxes.standard_deviation() / kFlux;
  std::printf("amplitude %.6f of what was injected; rms %.6f of its own, mean %.3g off\n", amplitude / kAmplitude,
              rms / (kAmplitude / std::sqrt(2.0)), fluxes.mean() / kFlux - 1.0);
  EXPECT_NEAR(amplitude / kAmplitude, 1.0, 0.01);
  EXPECT_NEAR(rms / (kAmplitude / std::sqrt(2.0)), 1.0, 0.01);
  EXPECT_LT(std::abs(fluxes.mean() / kFlux - 1.0), 1e-3 * kAmplitude);
}

TEST(LongSeries, InChunksIsThatOfOnePass) {
  constexpr std::int64_t kChunk = 4096;
  RunningMoments whole;
  RunningMoments merged;
  RunningMoments chunk;
  for (std::int64_t k = 0; k < kExposures / 10; ++k) {
    const double flux = kFlux * (1.0 + kAmplitude * std::sin(phase(k)));
    whole.add(flux);
    chunk.add(flux);
    if ((k + 1) % kChunk == 0 || k + 1 == kExposures / 10) {
      merged.merge(chunk);
      chunk = {};
    }
  }
  EXPECT_NEAR(merged.mean() / whole.mean(), 1.0, 1e-13);  // a million roundings, as a random walk
  EXPECT_NEAR(merged.standard_deviation() / whole.standard_deviation(), 1.0, 1e-6);
}

}  // namespace
}  // namespace astroid
