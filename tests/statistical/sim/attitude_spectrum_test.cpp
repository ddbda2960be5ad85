// Hard case N22: jitter with a given power spectral density has its power, its slope and no mean.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/sim/attitude.hpp"

namespace astroid {
namespace {

/// S = level (f / 1 Hz)^-alpha from low to high, in yaw; white of the same ends in pitch; nothing in roll.
JitterSpectrum power_law(double alpha, double level, double low, double high) {
  return {PowerSpectrum({low, high}, {level * std::pow(low, -alpha), level * std::pow(high, -alpha)}),
          PowerSpectrum({low, high}, {level, level}), PowerSpectrum({low, high}, {0.0, 0.0})};
}

SimulationSettings cadence(double cycle, double exposure) {
  SimulationSettings simulation;
  simulation.cycle = Seconds(cycle);
  simulation.exposure_time = Seconds(exposure);
  return simulation;
}

std::shared_ptr<const AttitudeModel> model(const JitterSpectrum& spectrum, double cycle, double exposure,
                                           std::uint64_t seed) {
  return make_spectrum_attitude(spectrum, "a power law", cadence(cycle, exposure),
                                make_stream(seed, StreamId{20}, 0, 0));
}

/// Power of a Hann-windowed series at a frequency (cycles per sample), one-sided density in units of dt = 1.
double density(const std::vector<double>& x, double frequency) {
  double re = 0.0;
  double im = 0.0;
  double windows = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = 0.5 - 0.5 * std::cos(2.0 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(x.size()));
    const double phase = 2.0 * kPi * frequency * static_cast<double>(i);
    re += w * x[i] * std::cos(phase);
    im += w * x[i] * std::sin(phase);
    windows += w * w;
  }
  return 2.0 * (re * re + im * im) / windows;
}

class SpectrumOfJitter : public testing::TestWithParam<double> {};

TEST_P(SpectrumOfJitter, HasTheSlopeAndTheLevelGiven) {
  const double alpha = GetParam();
  constexpr double kLow = 1e-4;   // Hz
  constexpr double kHigh = 0.49;  // below the Nyquist frequency of samples 1 s apart
  constexpr std::size_t kSamples = 8192;
  constexpr int kRealisations = 100;
  constexpr double kLevel = 3e-4;
  std::vector<double> frequencies;
  for (double f = 2e-3; f < 0.4; f *= 1.23) frequencies.push_back(f);
  std::vector<double> measured(frequencies.size(), 0.0);
  double mean_square = 0.0;
  for (int r = 0; r < kRealisations; ++r) {
    const auto attitude = model(power_law(alpha, kLevel, kLow, kHigh), 128.0, 128.0, 100U + static_cast<unsigned>(r))
                              ->sample(kSamples / 128, 128);
    std::vector<double> yaw;
    for (const Attitude& a : attitude) {
      yaw.push_back(a.yaw);
      EXPECT_EQ(a.roll, 0.0);
    }
    for (const double x : yaw) mean_square += x * x / static_cast<double>(kSamples) / kRealisations;
    for (std::size_t i = 0; i < frequencies.size(); ++i) measured[i] += density(yaw, frequencies[i]) / kRealisations;
  }
  // A straight line through the logarithms; each density has a relative error of 1/sqrt(100).
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  const auto n = static_cast<double>(frequencies.size());
  double level = 0.0;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double x = std::log(frequencies[i]);
    const double y = std::log(measured[i]);
    sx += x / n;
    sy += y / n;
    sxx += x * x / n;
    sxy += x * y / n;
    level += measured[i] / (kLevel * std::pow(frequencies[i], -alpha)) / n;
  }
  const double slope = (sxy - sx * sy) / (sxx - sx * sx);
  const double slope_error = 0.1 / std::sqrt(n * (sxx - sx * sx));
  const double z_level = (level - 1.0) * std::sqrt(n * kRealisations);
  std::printf("alpha %.1f: slope %.3f +- %.3f, level %.4f of the given (z = %.2f)\n", alpha, slope, slope_error, level,
              z_level);
  EXPECT_NEAR(slope, -alpha, 0.05);
  EXPECT_LT(std::abs(z_level), 4.0);
}

INSTANTIATE_TEST_SUITE_P(Slopes, SpectrumOfJitter, testing::Values(0.0, 1.0, 2.0));

TEST(JitterSpectrum, HasTheVarianceOfItsIntegralAtEveryTime) {
  // White noise: exactly level x bandwidth, whatever the place between two blocks of amplitudes.
  constexpr double kLevel = 0.02;
  const JitterSpectrum white = power_law(0.0, kLevel, 0.01, 0.64);
  const double expected = kLevel * (0.64 - 0.01);
  constexpr int kPhases = 8;
  constexpr std::int64_t kSamples = 40000;
  std::vector<double> squares(kPhases, 0.0);
  double mean = 0.0;
  double fourth = 0.0;
  // Blocks of the slowest octave last 1600 s and begin every 800 s: these instants fall on the same places between
  // them.
  const auto attitude = model(white, 100.0, 1.0, 3)->sample(kSamples, 1);
  for (std::size_t i = 0; i < attitude.size(); ++i) {
    const double x = attitude[i].yaw;
    squares[i % kPhases] += x * x * kPhases / static_cast<double>(kSamples);
    mean += x / static_cast<double>(kSamples);
    fourth += x * x * x * x / static_cast<double>(kSamples);
  }
  EXPECT_NEAR(model(white, 1.0, 1.0, 3)->variance().yaw, expected, 1e-15);
  for (const double s : squares) {
    const double z = (s / expected - 1.0) / std::sqrt(2.0 * kPhases / static_cast<double>(kSamples));
    std::printf("variance %.5f of %.5f, z = %.2f\n", s, expected, z);
    EXPECT_LT(std::abs(z), 4.0);
  }
  EXPECT_LT(std::abs(mean) / std::sqrt(expected / static_cast<double>(kSamples)), 4.0);
  const double kurtosis = fourth / (expected * expected);
  std::printf("kurtosis %.3f\n", kurtosis);
  EXPECT_NEAR(kurtosis, 3.0, 4.0 * std::sqrt(96.0 / static_cast<double>(kSamples)));
}

TEST(JitterSpectrum, PredictsTheVarianceOfMeans) {
  // Pink noise down to 2 h, exposures of 21 s every 25 s.
  const auto m = model(power_law(1.0, 1e-4, 1.4e-4, 1.0), 25.0, 21.0, 11);
  constexpr int kSteps = 42;
  constexpr std::int64_t kExposures = 30000;
  const std::vector<Attitude> all = m->sample(kExposures, kSteps);
  std::vector<double> means(kExposures, 0.0);
  for (std::size_t k = 0; k < means.size(); ++k)
    for (std::size_t i = 0; i < kSteps; ++i) means[k] += all[k * kSteps + i].yaw / kSteps;
  for (const std::int64_t count : {std::int64_t{1}, std::int64_t{12}, std::int64_t{144}}) {
    double sum = 0.0;
    double blocks = 0.0;
    for (std::size_t first = 0; first + static_cast<std::size_t>(count) <= means.size();
         first += static_cast<std::size_t>(count), ++blocks) {
      double mean = 0.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        mean += means[first + i] / static_cast<double>(count);
      sum += mean * mean;
    }
    const double expected = m->variance_of_mean(count).yaw;
    // Independent values: about one in the longest period, 7000 s, and one a block at most.
    const double independent = std::min(blocks, static_cast<double>(kExposures) * 25.0 / 3500.0);
    const double z = (sum / blocks / expected - 1.0) / std::sqrt(2.0 / independent);
    std::printf("mean of %3d exposures: variance %.4g of %.4g arcsec², z = %.2f\n", static_cast<int>(count),
                sum / blocks, expected, z);
    EXPECT_LT(std::abs(z), 4.0);
  }
}

TEST(JitterSpectrum, IsTheSameAtAnInstantHoweverItIsSampled) {
  const JitterSpectrum pink = power_law(1.0, 1e-4, 1e-4, 8.0);
  const auto one = model(pink, 25.0, 21.0, 5)->sample(40, 1);
  const auto seven = model(pink, 25.0, 21.0, 5)->sample(60, 7);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_NEAR(one[k].yaw, seven[7 * k + 3].yaw, 1e-12);
    EXPECT_NEAR(one[k].pitch, seven[7 * k + 3].pitch, 1e-12);
  }
  const auto longer = model(pink, 25.0, 21.0, 5)->sample(90, 7);
  for (std::size_t i = 0; i < seven.size(); ++i) {
    EXPECT_EQ(seven[i].yaw, longer[i].yaw);
    EXPECT_EQ(seven[i].pitch, longer[i].pitch);
  }
}

TEST(JitterSpectrum, TakesAsManyStepsAsTheMeanNeeds) {
  const auto m = model(power_law(1.0, 1e-4, 1e-4, 2.0), 25.0, 21.0, 5);
  const double rms = std::sqrt(m->variance().yaw);
  int previous = 0;
  for (const double fraction : {0.3, 0.03, 0.003}) {
    const int steps = m->steps_for(fraction);
    constexpr int kFine = 8;  // more steps, at the same instants and between them
    double squares = 0.0;
    constexpr std::int64_t kExposures = 400;
    const auto fine = m->sample(kExposures, steps * (2 * kFine + 1));
    for (std::size_t k = 0; k < kExposures; ++k) {
      double coarse_mean = 0.0;
      double fine_mean = 0.0;
      const auto per = static_cast<std::size_t>(2 * kFine + 1);
      for (std::size_t i = 0; i < static_cast<std::size_t>(steps); ++i) {
        coarse_mean += fine[(k * static_cast<std::size_t>(steps) + i) * per + kFine].yaw / steps;
        for (std::size_t j = 0; j < per; ++j)
          fine_mean +=
              fine[(k * static_cast<std::size_t>(steps) + i) * per + j].yaw / (steps * static_cast<double>(per));
      }
      squares += (coarse_mean - fine_mean) * (coarse_mean - fine_mean) / static_cast<double>(kExposures);
    }
    std::printf("%d steps for %.3f of the rms: error %.4f\n", steps, fraction, std::sqrt(squares) / rms);
    EXPECT_LT(std::sqrt(squares) / rms, 1.2 * fraction);
    EXPECT_GE(steps, previous);
    previous = steps;
  }
  EXPECT_GT(previous, 5);
}

TEST(PowerSpectrum, IntegratesPowerLawsExactly) {
  for (const double alpha : {0.0, 0.5, 1.0, 1.0 + 1e-12, 2.0, 4.0}) {
    const PowerSpectrum s({0.01, 10.0}, {std::pow(0.01, -alpha), std::pow(10.0, -alpha)});
    const double exact = std::abs(alpha - 1.0) < 1e-9
                             ? std::log(1000.0)
                             : (std::pow(10.0, 1.0 - alpha) - std::pow(0.01, 1.0 - alpha)) / (1.0 - alpha);
    EXPECT_NEAR(s.power() / exact, 1.0, 1e-11) << alpha;
    EXPECT_NEAR((s.power(0.01, 0.3) + s.power(0.3, 10.0)) / exact, 1.0, 1e-11) << alpha;
    EXPECT_EQ(s.power(20.0, 30.0), 0.0);
    EXPECT_EQ(s.density(0.001), 0.0);
  }
  const PowerSpectrum triangle({1.0, 2.0, 4.0}, {0.0, 6.0, 0.0});
  EXPECT_DOUBLE_EQ(triangle.power(), 9.0);
  EXPECT_DOUBLE_EQ(triangle.density(1.5), 3.0);
}

}  // namespace
}  // namespace astroid
