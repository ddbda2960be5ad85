#include "spectral_noise.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/distributions.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr std::size_t kPhasors = 4;  // of a line: cosine and sine of its phase, and of what a step adds
constexpr std::size_t kAmplitudes = 2 * SpectralNoise::kAxes;  // of a line in a block: cosine and sine of each axis

/// The later of two overlapping windows, and the earlier; their squares add up to 1. @param u  0 .. 1 of the overlap
struct Windows {
  double earlier, later;
};
Windows windows(double u) {
  const double s = det::sin(0.5 * kPi * u);
  const double angle = 0.5 * kPi * s * s;
  return {det::cos(angle), det::sin(angle)};
}

/// sin(pi x) / (pi x).
double sinc(double x) {
  const double angle = kPi * x;
  return std::fabs(angle) < 1e-8 ? 1.0 : det::sin(angle) / angle;
}

/// Amplitude that the mean of n instants, spaced x periods apart, leaves of a wave.
double comb(double x, double n) {
  const double below = det::sin(kPi * x);
  if (std::fabs(below) < 1e-9) return 1.0;  // every instant in phase, but for a sign that no square shows
  return det::sin(kPi * n * x) / (n * below);
}

}  // namespace

SpectralNoise::SpectralNoise(const JitterSpectrum& spectrum, const RandomStream& stream) : stream_(stream) {
  double lowest = spectrum[0].lowest();
  double highest = spectrum[0].highest();
  for (const PowerSpectrum& axis : spectrum) {
    lowest = std::min(lowest, axis.lowest());
    highest = std::max(highest, axis.highest());
  }
  std::size_t number = 0;
  for (double f = lowest; f < highest; f *= 2.0, ++number) {
    const double width = f / static_cast<double>(kLines);
    Octave octave{.lowest = f, .hop = 0.5 / width, .number = number, .frequency = {}, .variance = {}};
    double sum = 0.0;
    for (std::size_t k = 0; k < kLines; ++k) {
      const double from = f + width * static_cast<double>(k);
      octave.frequency[k] = from + 0.5 * width;
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        octave.variance[axis][k] = spectrum[axis].power(from, from + width);
        sum += octave.variance[axis][k];
      }
    }
    if (sum > 0.0) octaves_.push_back(octave);
  }
}

void SpectralNoise::draw(const Octave& octave, std::int64_t block, std::array<double, kLines>* values) const {
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    for (std::size_t part = 0; part < 2; ++part)
      for (std::size_t k = 0; k < kLines; ++k) {
        const double variance = octave.variance[axis][k];
        values[2 * axis + part][k] =
            variance > 0.0
                ? det::sqrt(variance) *
                      normal_at_step(stream_,
                                     {.step = static_cast<std::uint64_t>(block + 1),  // the first is block -1
                                      .axis = static_cast<std::uint32_t>(axis),
                                      .draw = static_cast<std::uint32_t>((octave.number * kLines + k) * 2 + part)})
                : 0.0;
      }
}

void SpectralNoise::at(double begin, double step, std::span<Attitude> out, Blocks& blocks) const {
  if (blocks.number.size() != octaves_.size()) {
    blocks.number.assign(octaves_.size(), -2);
    blocks.values.resize(octaves_.size() * 2 * kAmplitudes);
    blocks.phasors.resize(octaves_.size() * kPhasors);
    blocks.step = 0.0;
  }
  const bool new_step = blocks.step != step;
  blocks.step = step;
  for (std::size_t o = 0; o < octaves_.size(); ++o) {
    auto* phasor = &blocks.phasors[o * kPhasors];
    for (std::size_t k = 0; k < kLines; ++k) {
      // Whole turns are taken off before they cost digits: a year is 1e9 turns at 30 Hz.
      const double turns = octaves_[o].frequency[k] * (begin + 0.5 * step);
      const double phase = 2.0 * kPi * (turns - std::floor(turns));
      phasor[0][k] = det::cos(phase);
      phasor[1][k] = det::sin(phase);
      if (!new_step) continue;
      const double turn = 2.0 * kPi * octaves_[o].frequency[k] * step;
      phasor[2][k] = det::cos(turn);
      phasor[3][k] = det::sin(turn);
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double time = begin + (static_cast<double>(i) + 0.5) * step;
    std::array<std::array<double, kLines>, kAxes> sum{};
    for (std::size_t o = 0; o < octaves_.size(); ++o) {
      const double place = time / octaves_[o].hop;
      const double whole = std::floor(place);
      const auto block = static_cast<std::int64_t>(whole);
      auto* earlier = &blocks.values[o * 2 * kAmplitudes];
      auto* later = earlier + kAmplitudes;
      if (blocks.number[o] != block) {
        if (blocks.number[o] == block - 1) {
          std::copy(later, later + kAmplitudes, earlier);
        } else {
          draw(octaves_[o], block - 1, earlier);
        }
        draw(octaves_[o], block, later);
        blocks.number[o] = block;
      }
      const Windows w = windows(place - whole);
      auto* phasor = &blocks.phasors[o * kPhasors];
      for (std::size_t axis = 0; axis < kAxes; ++axis)
        for (std::size_t k = 0; k < kLines; ++k)
          sum[axis][k] += (w.earlier * earlier[2 * axis][k] + w.later * later[2 * axis][k]) * phasor[0][k] +
                          (w.earlier * earlier[2 * axis + 1][k] + w.later * later[2 * axis + 1][k]) * phasor[1][k];
      for (std::size_t k = 0; k < kLines; ++k) {
        const double cosine = phasor[0][k] * phasor[2][k] - phasor[1][k] * phasor[3][k];
        phasor[1][k] = phasor[1][k] * phasor[2][k] + phasor[0][k] * phasor[3][k];
        phasor[0][k] = cosine;
      }
    }
    std::array<double, kAxes> total{};
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      for (const double part : sum[axis]) total[axis] += part;
    out[i] = {total[0], total[1], total[2]};
  }
}

template <class Response>
AttitudeVariance SpectralNoise::filtered(double longest, Response&& response) const {
  constexpr double kSamplesPerWave = 6.0;  // of the response, whose fastest wave along frequency is 1/longest
  constexpr double kFewest = 4.0;
  constexpr double kMost = 2048.0;
  constexpr double kGolden = 0.6180339887498949;  // of places that no wave follows
  std::array<double, kAxes> sum{};
  for (const Octave& octave : octaves_) {
    const double width = octave.lowest / static_cast<double>(kLines);
    const auto samples =
        static_cast<std::size_t>(std::clamp(std::ceil(kSamplesPerWave * width * longest), kFewest, kMost));
    for (std::size_t k = 0; k < kLines; ++k) {
      double mean = 0.0;
      for (std::size_t i = 0; i < samples; ++i) {
        const double place = (static_cast<double>(i) + 0.5) * kGolden;
        mean +=
            response(octave.frequency[k] + width * (place - std::floor(place) - 0.5)) / static_cast<double>(samples);
      }
      for (std::size_t axis = 0; axis < kAxes; ++axis) sum[axis] += octave.variance[axis][k] * mean;
    }
  }
  return {sum[0], sum[1], sum[2]};
}

AttitudeVariance SpectralNoise::variance() const {
  std::array<double, kAxes> sum{};
  for (const Octave& octave : octaves_)
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      for (const double v : octave.variance[axis]) sum[axis] += v;
  return {sum[0], sum[1], sum[2]};
}

AttitudeVariance SpectralNoise::variance_of_mean(double length, double cycle, std::int64_t count) const {
  const auto n = static_cast<double>(count);
  return filtered(n * cycle, [&](double f) {
    const double response = sinc(f * length) * comb(f * cycle, n);
    return response * response;
  });
}

AttitudeVariance SpectralNoise::covariance_of_mean(double length, double cycle, std::int64_t count, double lag) const {
  const auto n = static_cast<double>(count);
  return filtered(n * cycle + std::fabs(lag), [&](double f) {
    const double response = sinc(f * length) * comb(f * cycle, n);
    return response * response * det::cos(2.0 * kPi * f * lag);
  });
}

AttitudeVariance SpectralNoise::sampling_variance(double length, int steps) const {
  return filtered(length, [&](double f) {
    const double error = comb(f * length / steps, steps) - sinc(f * length);
    return error * error;
  });
}

}  // namespace astroid
