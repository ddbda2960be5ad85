// The level of a sky under faint stars, from the distribution of its pixels.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace astroid::detail {

/// Pixels of sky, noise alone, and pixels in the wings and cores of stars, whose light has a density as 1/light: the
/// area of a Gaussian star where its light is between s and s + ds is 2π σ² ds / s, whatever its flux.
///
/// Everything is in units of the rms of a pixel. Noise is normal with the skewness of photons; light brings its own
/// photon noise. Light ranges from 0.02 to 4.
class LightUnderSky {
 public:
  static constexpr double kReach = 4.0;  // rms on either side of the reference that are compared
  static constexpr double kStep = 0.1;   // rms, of bins
  static constexpr std::size_t kBins = 80;

  /// @param skewness  of the noise of a pixel of sky.  @param photon_noise  variance that one rms of light adds, rms²
  LightUnderSky(double skewness, double photon_noise);

  struct Fit {
    double level = 0.0;      ///< rms, relative to the reference of the histogram
    double sigma = 1.0;      ///< of the noise, relative to the rms of the histogram
    double lit = 0.0;        ///< share of pixels with light of stars
    double error = 0.0;      ///< of the level, from the counts
    double misfit = 0.0;     ///< chi² per pixel beyond that of counts: 0 for the model itself
    bool converged = false;  ///< and the misfit is small: pixels are distributed like this
  };
  /// Maximum likelihood of counts in bins. @param bins  shape (kBins)
  [[nodiscard]] Fit fit(std::span<const double> bins) const;

 private:
  struct Parameters {
    double level, sigma, lit;
  };
  [[nodiscard]] double table_at(const std::vector<double>& table, double u) const;
  void probabilities(const Parameters& p, std::span<double> out) const;
  [[nodiscard]] double log_likelihood(std::span<const double> bins, const Parameters& p) const;

  std::vector<double> dark_;  // cumulative distribution of sky alone, and of pixels with light
  std::vector<double> lit_;
};

}  // namespace astroid::detail
