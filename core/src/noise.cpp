#include "astroid/core/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double ratio(double variance, double signal) {
  return signal > 0.0 ? std::sqrt(variance) / signal : kInfinity;
}

}  // namespace

double PixelNoise::variance(double light) const {
  if (ramp.reads <= 1) return light + (background + readout * readout + quantisation * quantisation);
  const RampVariance fit = factors(light);
  // Each read is rounded, and so is what is delivered.
  return fit.photon * (light + background) + fit.readout * (readout * readout + quantisation * quantisation) +
         quantisation * quantisation;
}

double ccd_equation_snr(const CcdEquation& terms) {
  const double adc = terms.gain * terms.adc_noise;
  const double per_pixel = terms.sky + terms.dark + terms.readout_noise * terms.readout_noise + adc * adc;
  const double pixels = terms.pixels * (1.0 + terms.pixels / terms.background_pixels);
  return terms.star / std::sqrt(terms.star + pixels * per_pixel);
}

double nsr_exposure(std::span<const double> target, std::span<const double> total, std::span<const double> weights,
                    const PixelNoise& noise) {
  ASTROID_CHECK_EQ(target.size(), total.size());
  ASTROID_CHECK_EQ(target.size(), weights.size());
  double signal = 0.0;
  double variance = 0.0;
  for (std::size_t n = 0; n < target.size(); ++n) {
    signal += target[n] * weights[n];
    variance += noise.variance(total[n]) * weights[n] * weights[n];
  }
  return ratio(variance, signal);
}

double nsr_of_mask(std::span<const double> target, std::span<const double> total, std::span<const std::size_t> mask,
                   const PixelNoise& noise) {
  ASTROID_CHECK_EQ(target.size(), total.size());
  double signal = 0.0;
  double variance = 0.0;
  for (const std::size_t n : mask) {
    signal += target[n];
    variance += noise.variance(total[n]);
  }
  return ratio(variance, signal);
}

Ppm nsr_averaged(double nsr, double exposures, double cameras) {
  constexpr double kPpm = 1e6;
  return Ppm(kPpm * nsr / std::sqrt(exposures * cameras));
}

MaskGrowth grow_mask(std::span<const double> target, std::span<const double> total, const PixelNoise& noise) {
  ASTROID_CHECK_EQ(target.size(), total.size());
  std::vector<double> pixel_nsr(target.size());
  MaskGrowth growth;
  for (std::size_t n = 0; n < target.size(); ++n) {
    pixel_nsr[n] = ratio(noise.variance(total[n]), target[n]);
    if (pixel_nsr[n] < kInfinity) growth.order.push_back(n);  // neither without target flux nor NaN
  }
  std::stable_sort(growth.order.begin(), growth.order.end(),
                   [&](std::size_t a, std::size_t b) { return pixel_nsr[a] < pixel_nsr[b]; });
  // Rings of equal pixels: within one, rounding decided the order, so the indices do now.
  const std::size_t size = growth.order.size();
  for (std::size_t first = 0, next = 0; first < size; first = next) {
    const double limit = pixel_nsr[growth.order[first]] * (1.0 + kNsrTie);
    while (next < size && pixel_nsr[growth.order[next]] <= limit) ++next;
    const auto begin = growth.order.begin();
    std::sort(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(next));
    growth.allowed.push_back(next);
  }
  double signal = 0.0;
  double variance = 0.0;
  for (const std::size_t n : growth.order) {
    signal += target[n];
    variance += noise.variance(total[n]);
    growth.nsr.push_back(ratio(variance, signal));
  }
  return growth;
}

std::vector<std::size_t> optimal_binary_mask(std::span<const double> target, std::span<const double> total,
                                             const PixelNoise& noise) {
  MaskGrowth growth = grow_mask(target, total, noise);
  std::size_t best = 0;
  double least = kInfinity;
  for (const std::size_t size : growth.allowed) {
    if (growth.nsr[size - 1] < least) {
      least = growth.nsr[size - 1];
      best = size;
    }
  }
  growth.order.resize(best);
  return std::move(growth.order);
}

std::vector<double> optimal_weights(std::span<const double> target, std::span<const double> total,
                                    const PixelNoise& noise) {
  ASTROID_CHECK_EQ(target.size(), total.size());
  std::vector<double> weights(target.size());
  for (std::size_t n = 0; n < target.size(); ++n) {
    const double variance = noise.variance(total[n]);
    weights[n] = target[n] > 0.0 && variance > 0.0 ? target[n] / variance : 0.0;
  }
  const double largest = weights.empty() ? 0.0 : *std::max_element(weights.begin(), weights.end());
  if (largest > 0.0) {
    for (double& weight : weights) weight /= largest;
  }
  return weights;
}

}  // namespace astroid
