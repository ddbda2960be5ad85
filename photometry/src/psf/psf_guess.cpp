#include "psf/psf_guess.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

constexpr double kPixelVariance = 1.0 / 12.0;  // px², of light spread over a pixel
constexpr double kNarrowest = 0.2;             // px
constexpr double kWidest = 20.0;               // px

struct Maximum {
  float peak;
  double inverse_variance;  // 1/px², of the star with the pixel
};

// Fractions of a Gaussian in pixels at the nodes of a grid along one axis.
std::vector<double> gaussian_profile(double sigma, int samples_per_pixel, int half) {
  std::vector<double> profile;
  constexpr double kRootHalf = 0.7071067811865476;
  for (int i = -half; i <= half; ++i) {
    const double d = std::abs(static_cast<double>(i)) / samples_per_pixel;
    const double lower = (d - 0.5) / sigma * kRootHalf;
    const double upper = (d + 0.5) / sigma * kRootHalf;
    profile.push_back(0.5 * (det::erfc(lower) - det::erfc(upper)));
  }
  return profile;
}

}  // namespace

double guess_sigma(const FieldPixels& pixels) {
  constexpr double kPeak = 30.0;      // sigma of the sky, of the pixel of a bright star
  constexpr double kShoulder = 5.0;   // sigma, of the pixels beside it
  constexpr std::size_t kMost = 400;  // stars
  std::vector<Maximum> maxima;
  for (int y = 1; y + 1 < pixels.electrons.ny(); ++y) {
    for (int x = 1; x + 1 < pixels.electrons.nx(); ++x) {
      const double sky = *pixels.sky.at(x, y);
      const double noise = std::sqrt(std::max(sky, 0.0) + pixels.read_variance);
      const double peak = *pixels.electrons.at(x, y) - sky;
      if (!(peak > kPeak * noise)) continue;
      std::array<double, 9> values{};
      bool good = true;
      std::size_t k = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          good = good && *pixels.usable.at(x + i, y + j) > 0.0F;
          values[k++] = *pixels.electrons.at(x + i, y + j) - sky;
        }
      if (!good || std::ranges::max(values) > peak) continue;
      const double least = kShoulder * noise;
      if (!(std::min({values[1], values[3], values[5], values[7]}) > least)) continue;
      const double sum = det::log(peak / values[3]) + det::log(peak / values[5]) + det::log(peak / values[1]) +
                         det::log(peak / values[7]);
      maxima.push_back({static_cast<float>(peak), 0.5 * sum});
    }
  }
  if (maxima.empty()) return 0.0;
  std::ranges::stable_sort(maxima, [](const Maximum& a, const Maximum& b) { return a.peak > b.peak; });
  if (maxima.size() > kMost) maxima.resize(kMost);
  const auto middle = maxima.begin() + static_cast<std::ptrdiff_t>(maxima.size() / 2);
  std::ranges::nth_element(maxima, middle, {}, &Maximum::inverse_variance);
  if (!(middle->inverse_variance > 0.0)) return kWidest;
  const double variance = 1.0 / middle->inverse_variance - kPixelVariance;
  return std::clamp(std::sqrt(std::max(variance, 0.0)), kNarrowest, kWidest);
}

EffectivePsf effective_gaussian(double sigma, int samples_per_pixel, int half) {
  EffectivePsf psf;
  psf.samples_per_pixel = samples_per_pixel;
  psf.half = half;
  const std::vector<double> profile = gaussian_profile(sigma, samples_per_pixel, half);
  for (const double y : profile)
    for (const double x : profile) psf.coefficients.push_back(x * y);
  spline_coefficients_of(psf.coefficients, psf.side());
  return psf;
}

double nearest_sigma(const EffectivePsf& psf) {
  std::vector<double> values(psf.coefficients.begin(),
                             psf.coefficients.begin() + static_cast<std::ptrdiff_t>(psf.plane_size()));
  spline_values_of(values, psf.side());
  const auto distance = [&](double sigma) {
    const std::vector<double> profile = gaussian_profile(sigma, psf.samples_per_pixel, psf.half);
    double sum = 0.0;
    std::size_t i = 0;
    for (const double y : profile)
      for (const double x : profile) {
        const double d = values[i++] - x * y;
        sum += d * d;
      }
    return sum;
  };
  // Golden section in the logarithm.
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 40;
  double low = det::log(kNarrowest);
  double high = det::log(kWidest);
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double fa = distance(det::exp(a));
  double fb = distance(det::exp(b));
  for (int i = 0; i < kSteps; ++i) {
    if (fa < fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - kGolden * (high - low);
      fa = distance(det::exp(a));
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + kGolden * (high - low);
      fb = distance(det::exp(b));
    }
  }
  return det::exp(0.5 * (low + high));
}

}  // namespace astroid::detail
