#include "mesh/light_under_sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"
#include "small_matrix.hpp"

namespace astroid::detail {

namespace {

// Tables of the distributions reach from kFirst in steps of 1/kPerUnit; cubic interpolation is good to 1e-5.
constexpr double kFirst = -9.0;
constexpr double kLast = 9.0;
constexpr double kPerUnit = 16.0;
constexpr double kFaintest = 0.02;  // rms
constexpr double kBrightest = 4.0;

// Of a normal variable with the third cumulant of photons, to first order (Edgeworth).
double skewed_normal(double z, double skewness) {
  const double density = det::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi);
  return 0.5 * det::erfc(-z / std::sqrt(2.0)) - skewness / 6.0 * (z * z - 1.0) * density;
}

}  // namespace

LightUnderSky::LightUnderSky(double skewness, double photon_noise) {
  const auto size = static_cast<std::size_t>((kLast - kFirst) * kPerUnit) + 4;
  constexpr int kLights = 24;
  std::array<double, kLights> light{};
  std::array<double, kLights> scale{};
  const double ratio = det::log10(kBrightest / kFaintest);
  for (std::size_t k = 0; k < kLights; ++k) {
    light[k] = kFaintest * det::exp10((static_cast<double>(k) + 0.5) / kLights * ratio);
    scale[k] = 1.0 / std::sqrt(1.0 + photon_noise * light[k]);
  }
  dark_.resize(size);
  lit_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double u = kFirst + (static_cast<double>(i) - 1.0) / kPerUnit;
    dark_[i] = skewed_normal(u, skewness);
    double sum = 0.0;
    for (std::size_t k = 0; k < kLights; ++k) sum += skewed_normal((u - light[k]) * scale[k], skewness);
    lit_[i] = sum / kLights;
  }
}

// Cubic through four points.
double LightUnderSky::table_at(const std::vector<double>& table, double u) const {
  const double t = std::clamp((u - kFirst) * kPerUnit, 0.0, (kLast - kFirst) * kPerUnit - 1e-9);
  const auto i = static_cast<std::size_t>(t);
  const double f = t - static_cast<double>(i);
  const double* v = table.data() + i;
  const double a = (1.0 - f) * (2.0 - f) * f / -6.0;
  const double b = (1.0 - f) * (2.0 - f) * (1.0 + f) / 2.0;
  const double c = f * (1.0 + f) * (2.0 - f) / 2.0;
  const double d = -f * (1.0 - f) * (1.0 + f) / 6.0;
  return a * v[0] + b * v[1] + c * v[2] + d * v[3];
}

void LightUnderSky::probabilities(const Parameters& p, std::span<double> out) const {
  double last = 0.0;
  double total = 0.0;
  for (std::size_t k = 0; k <= kBins; ++k) {
    const double u = (-kReach + kStep * static_cast<double>(k) - p.level) / p.sigma;
    const double value = (1.0 - p.lit) * table_at(dark_, u) + p.lit * table_at(lit_, u);
    if (k > 0) {
      // Far in the tails the expansion may go below nothing.
      out[k - 1] = std::max(value - last, 1e-9);
      total += out[k - 1];
    }
    last = value;
  }
  for (double& q : out) q /= total;
}

double LightUnderSky::log_likelihood(std::span<const double> bins, const Parameters& p) const {
  std::array<double, kBins> q{};
  probabilities(p, q);
  double sum = 0.0;
  for (std::size_t k = 0; k < kBins; ++k)
    if (bins[k] > 0.0) sum += bins[k] * det::log10(q[k]);
  return sum;
}

LightUnderSky::Fit LightUnderSky::fit(std::span<const double> bins) const {
  Fit result;
  double total = 0.0;
  for (const double n : bins) total += n;
  if (!(total > 0.0)) return result;
  Parameters p{-0.1, 0.98, 0.2};
  double likelihood = log_likelihood(bins, p);
  constexpr int kIterations = 50;
  constexpr double kDifference = 1e-4;
  constexpr double kMostLit = 0.95;
  for (int n = 0; n < kIterations; ++n) {
    // Fisher scoring: information sum N (dq)(dq)ᵀ/q, gradient sum (h/q) dq.
    std::array<double, kBins> q{};
    std::array<std::array<double, kBins>, 3> up{};
    std::array<double, kBins> down{};
    probabilities(p, q);
    for (std::size_t a = 0; a < 3; ++a) {
      Parameters high = p;
      Parameters low = p;
      (a == 0 ? high.level : a == 1 ? high.sigma : high.lit) += kDifference;
      (a == 0 ? low.level : a == 1 ? low.sigma : low.lit) -= kDifference;
      probabilities(high, up[a]);
      probabilities(low, down);
      for (std::size_t k = 0; k < kBins; ++k) up[a][k] = (up[a][k] - down[k]) / (2.0 * kDifference);
    }
    std::array<double, 6> information{};
    std::array<double, 3> gradient{};
    for (std::size_t k = 0; k < kBins; ++k) {
      std::size_t element = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        gradient[a] += bins[k] / q[k] * up[a][k];
        for (std::size_t b = a; b < 3; ++b) information[element++] += total * up[a][k] * up[b][k] / q[k];
      }
    }
    const std::array<double, 9> covariance = inverse_of_symmetric(information);
    if (!(covariance[0] > 0.0)) return result;
    result.error = std::sqrt(covariance[0]);
    std::array<double, 3> step{};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) step[a] += covariance[3 * a + b] * gradient[b];
    bool better = false;
    double shift = 0.0;
    for (double length = 1.0; length > 1e-3 && !better; length *= 0.5) {
      const Parameters next{std::clamp(p.level + length * step[0], -2.0, 1.0),
                            std::clamp(p.sigma + length * step[1], 0.5, 1.5),
                            std::clamp(p.lit + length * step[2], 0.0, kMostLit)};
      const double value = log_likelihood(bins, next);
      better = value > likelihood;
      if (better) {
        shift = std::abs(next.level - p.level);
        p = next;
        likelihood = value;
      }
    }
    constexpr double kSettled = 1e-5;  // rms
    if (!better || shift < kSettled) {
      result.converged = true;
      break;
    }
  }
  std::array<double, kBins> q{};
  probabilities(p, q);
  for (std::size_t k = 0; k < kBins; ++k) {
    const double difference = bins[k] / total - q[k];
    result.misfit += difference * difference / std::max(q[k], 1.0 / total);
  }
  result.misfit = std::max(0.0, result.misfit - static_cast<double>(kBins) / total);
  // The crowd that this was tried on has 0.003; a steep gradient across a cell, or digitisation in a few steps, more.
  constexpr double kWorst = 0.02;
  result.converged = result.converged && result.misfit < kWorst;
  result.level = p.level;
  result.sigma = p.sigma;
  result.lit = p.lit;
  return result;
}

}  // namespace astroid::detail
