// Power spectral density of pointing jitter: the file, its integral, and noise that has it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace astroid {

/// A one-sided power spectral density, given at some frequencies and a power law between them; nothing outside.
class PowerSpectrum {
 public:
  PowerSpectrum() = default;
  /// @param frequency  Hz, > 0, increasing, at least two.  @param density  >= 0, square units per Hz.
  PowerSpectrum(std::vector<double> frequency, std::vector<double> density);

  [[nodiscard]] double lowest() const { return frequency_.front(); }
  [[nodiscard]] double highest() const { return frequency_.back(); }
  /// Density at a frequency: a power law between the given ones, a straight line where one of the two is 0.
  [[nodiscard]] double density(double frequency) const;
  /// Integral from `low` to `high`, exact for the interpolated density. @accuracy 1e-13 relative
  [[nodiscard]] double power(double low, double high) const;
  [[nodiscard]] double power() const { return power(lowest(), highest()); }

 private:
  [[nodiscard]] double power_within(std::size_t interval, double low, double high) const;

  std::vector<double> frequency_;
  std::vector<double> density_;
};

/// Yaw, pitch and roll, arcsec²/Hz.
using JitterSpectrum = std::array<PowerSpectrum, 3>;

/// Reads columns frequency_hz, yaw, pitch, roll (Hz, arcsec²/Hz).
/// @throws InputError with every bad line; EnvironmentError.
JitterSpectrum read_jitter_spectrum(const std::string& path);

}  // namespace astroid
