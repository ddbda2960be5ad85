#include "astroid/core/gaussian_aperture.hpp"

#include <cmath>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kRootTwo = 1.41421356237309504880168872420969808;

// Probability of n under a Poisson law of this mean, for n the integer part of the mean.
double poisson_mode_probability(double mean) {
  const double n = std::floor(mean);
  constexpr double kDirect = 20.0;  // up to here the factorial itself, beyond Stirling's series is good to 1e-17
  if (n < kDirect) {
    double p = det::exp(-mean);
    for (int k = 1; k <= static_cast<int>(n); ++k) p *= mean / k;
    return p;
  }
  const double excess = mean - n;
  const double square = n * n;
  const double stirling = (1.0 / 12.0 - (1.0 / 360.0 - (1.0 / 1260.0 - 1.0 / (1680.0 * square)) / square) / square) / n;
  return det::exp(n * det::log1p(excess / n) - excess - stirling) / std::sqrt(2.0 * kPi * n);
}

// Poisson probabilities of 0 … last, outwards from the mode so that none underflows that matters.
std::vector<double> poisson_probabilities(double mean, std::size_t last) {
  std::vector<double> p(last + 1, 0.0);
  const auto mode = static_cast<std::size_t>(mean);
  p[mode] = poisson_mode_probability(mean);
  for (std::size_t n = mode; n < last; ++n) p[n + 1] = p[n] * mean / static_cast<double>(n + 1);
  for (std::size_t n = mode; n > 0; --n) p[n - 1] = p[n] * static_cast<double>(n) / mean;
  return p;
}

}  // namespace

double gaussian_in_circle(double sigma, double radius, double distance) {
  const double s = radius * radius / (2.0 * sigma * sigma);
  const double t = distance * distance / (2.0 * sigma * sigma);
  constexpr double kFarTail = 12.0;    // standard deviations of a Poisson law that hold all but 1e-30 of it …
  constexpr double kSmallMean = 60.0;  // … with this many more for laws that are not yet Gaussian
  const auto last = static_cast<std::size_t>(s + t + kFarTail * std::sqrt(s + t) + kSmallMean);
  const std::vector<double> shifted = poisson_probabilities(t, last);
  const std::vector<double> circle = poisson_probabilities(s, last + 1);
  double tail = 0.0;  // sum of circle[k] over k > n, only ever added to
  double fraction = 0.0;
  for (std::size_t n = last + 1; n-- > 0;) {
    tail += circle[n + 1];
    fraction += shifted[n] * tail;
  }
  return fraction;
}

double gaussian_in_interval(double sigma, double half_width, double offset) {
  const double scale = 1.0 / (kRootTwo * sigma);
  return 0.5 * (det::erf((half_width - offset) * scale) + det::erf((half_width + offset) * scale));
}

double gaussian_interval_gradient(double sigma, double half_width, double offset) {
  const double upper = (half_width - offset) / sigma;
  const double lower = (half_width + offset) / sigma;
  const double slope =
      (det::exp(-0.5 * lower * lower) - det::exp(-0.5 * upper * upper)) / (std::sqrt(2.0 * kPi) * sigma);
  return slope / gaussian_in_interval(sigma, half_width, offset);
}

OptimalCircularAperture optimal_circular_aperture() {
  double x = 1.25;  // Newton on exp(x) - 1 - 2 x from close by
  constexpr int kSteps = 6;
  for (int i = 0; i < kSteps; ++i) x -= (det::expm1(x) - 2.0 * x) / (det::exp(x) - 2.0);
  OptimalCircularAperture best{};
  best.radius_sigma = std::sqrt(2.0 * x);
  best.radius_fwhm = best.radius_sigma / kFwhmPerSigma;
  best.enclosed = -det::expm1(-x);
  // Noise ~ sqrt(pi r^2) against the PSF fit's sqrt(4 pi sigma^2).
  best.snr_ratio = 2.0 * best.enclosed / best.radius_sigma;
  return best;
}

}  // namespace astroid
