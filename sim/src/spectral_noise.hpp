// Noise with a given power spectral density, a pure function of absolute time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/random.hpp"
#include "astroid/sim/attitude.hpp"
#include "astroid/sim/jitter_spectrum.hpp"

namespace astroid {

/// Three independent stationary Gaussian processes (yaw, pitch, roll).
///
/// Each octave of frequency, from the lowest of the spectrum, has sixteen equally spaced lines, which carry the power
/// of the spectrum around them. The amplitudes of their cosines and sines are drawn anew for every block of sixteen
/// periods of the octave's lowest frequency; blocks overlap by half, under windows whose squares add up to 1. So the
/// variance is that of the spectrum at every time, the spectrum is continuous, with a resolution of 1/16 to 1/32 of the
/// frequency, nothing repeats, and any time can be asked for alone.
/// @source Shinozuka1991 (sums of cosines), PrincenBradley1986 (windows that overlap); the window is
/// sin(pi/2 sin²(pi/2 u)), whose spectrum falls fast enough for spectra up to f^-5.
class SpectralNoise {
 public:
  static constexpr std::size_t kLines = 16;  ///< of an octave
  static constexpr std::size_t kAxes = 3;

  SpectralNoise(const JitterSpectrum& spectrum, const RandomStream& stream);

  /// What is remembered of the blocks around the last time asked for; any state gives the same values.
  struct Blocks {
    double step = 0.0;                                ///< s, that the phasors turn by
    std::vector<std::int64_t> number;                 ///< [octave] of the later of the two blocks
    std::vector<std::array<double, kLines>> values;   ///< [octave][earlier, later][axis][cosine, sine]
    std::vector<std::array<double, kLines>> phasors;  ///< [octave][cosine, sine, of one step: cosine, sine]
  };

  /// The noise at `begin` + (i + 1/2) `step`, i = 0 … out.size() - 1; arcsec. @param begin  s, >= 0
  void at(double begin, double step, std::span<Attitude> out, Blocks& blocks) const;

  /// Variance of the mean of `count` means over `length` that begin `cycle` apart. @accuracy 1 % of variance()
  [[nodiscard]] AttitudeVariance variance_of_mean(double length, double cycle, std::int64_t count) const;
  /// Covariance of that mean with the same one `lag` later, s. @accuracy as variance_of_mean()
  [[nodiscard]] AttitudeVariance covariance_of_mean(double length, double cycle, std::int64_t count, double lag) const;
  /// Variance of the error that the mean of `steps` instants makes of the mean over `length`.
  [[nodiscard]] AttitudeVariance sampling_variance(double length, int steps) const;
  [[nodiscard]] AttitudeVariance variance() const;

 private:
  struct Octave {
    double lowest;  ///< Hz
    double hop;     ///< s, half the length of a block
    std::size_t number;
    std::array<double, kLines> frequency;
    std::array<std::array<double, kLines>, kAxes> variance;
  };

  /// The amplitudes of a block.
  void draw(const Octave& octave, std::int64_t block, std::array<double, kLines>* values) const;
  /// Sum over lines of variance x response(f), the response averaged over the band of each line.
  /// @param longest  s: the response changes over 1/longest Hz.
  template <class Response>
  [[nodiscard]] AttitudeVariance filtered(double longest, Response&& response) const;

  std::vector<Octave> octaves_;  // those with power
  RandomStream stream_;
};

}  // namespace astroid
