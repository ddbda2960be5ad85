// Laws that hold over the whole range of every parameter, tried on ten thousand random cases each, the same every time;
// `make nightly` tries a million others.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "astroid/core/bounds.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/distributions.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

/// Read by rapidcheck when its first property is tried; what is set in the environment wins.
const bool kManyCases = setenv("RC_PARAMS", "seed=1 max_success=10000", 0) == 0;

/// Evenly distributed in the logarithm, from any 32 bits.
double between(double low, double high, std::uint32_t bits) {
  return low * std::pow(high / low, static_cast<double>(bits) / 4294967295.0);
}
double evenly(double low, double high, std::uint32_t bits) {
  return low + (high - low) * (static_cast<double>(bits) / 4294967295.0);
}
using Bits = std::uint32_t;
/// All 32 bits are as likely as any, whatever the size that rapidcheck thinks of.
Bits draw() {
  return *rc::gen::resize(100, rc::gen::arbitrary<Bits>());
}

std::vector<double> stamp(const PixelPsf& psf, PixelPosition star, Rectangle box) {
  std::vector<double> fractions(box.size());
  psf.integrate(star, box, fractions);
  return fractions;
}

// Widths 1e-12 … 100 px, stars up to 1e6 px beside the frame.
RC_GTEST_PROP(GaussianOfAnyWidthProperties, IsFiniteNotNegativeAndConserved, ()) {
  const double sigma = between(1e-12, 100.0, draw());
  const double far = draw() % 4 == 0 ? 1e6 : 20.0;
  const PixelPosition star{evenly(-far, far, draw()), evenly(-far, far, draw())};
  const std::vector<double> fractions = stamp(*make_gaussian_psf(sigma), star, {-15, -15, 31, 31});
  double sum = 0.0;
  for (const double f : fractions) {
    RC_ASSERT(std::isfinite(f));
    RC_ASSERT(f >= 0.0);
    sum += f;
  }
  RC_ASSERT(sum <= 1.0 + 1e-12);
  const double margin = 15.5 - std::max(std::abs(star.x), std::abs(star.y));
  if (margin > 10.0 * sigma) RC_ASSERT(std::abs(sum - 1.0) < 1e-12);
}

RC_GTEST_PROP(GaussianOfAnyWidthProperties, IsMirroredWithItsStar, ()) {
  const double sigma = between(1e-12, 100.0, draw());
  // Positions are multiples of 2^-24 px in every scene: their mirror images are exact.
  const auto place = [] { return std::round(evenly(-5.0, 5.0, draw()) * 16777216.0) / 16777216.0; };
  const PixelPosition star{place(), place()};
  const auto psf = make_gaussian_psf(sigma);
  const std::vector<double> one = stamp(*psf, star, {-8, -8, 17, 17});
  std::vector<double> other = stamp(*psf, {-star.x, -star.y}, {-8, -8, 17, 17});
  std::ranges::reverse(other);
  RC_ASSERT(one == other);
}

RC_GTEST_PROP(GaussianOfAnyWidthProperties, FallsWithTheDistanceFromTheStar, ()) {
  const double sigma = between(1e-3, 100.0, draw());
  const double x = evenly(-0.5, 0.5, draw());
  const std::vector<double> row = stamp(*make_gaussian_psf(sigma), {x, 0.0}, {0, 0, 30, 1});
  for (std::size_t i = 1; i < row.size(); ++i) RC_ASSERT(row[i] <= row[i - 1]);
}

// Magnitudes -30 … 40.
RC_GTEST_PROP(MagnitudesProperties, RoundTripAndFallWithTheRate, ()) {
  const Magnitude zero_point(evenly(-30.0, 40.0, draw()));
  const Magnitude magnitude(evenly(-30.0, 40.0, draw()));
  const ElectronsPerSecond rate = electron_rate(magnitude, zero_point);
  RC_ASSERT(std::isfinite(rate.value()) && rate.value() > 0.0);
  const auto back = magnitude_of(rate, zero_point);
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::abs(back->value() - magnitude.value()) < 1e-12);
  const Magnitude fainter(magnitude.value() + between(1e-6, 10.0, draw()));
  RC_ASSERT(electron_rate(fainter, zero_point) < rate);
}

// Counts of any size and sign, converters of 1 … 32 bits.
RC_GTEST_PROP(DigitiseProperties, StaysInRangeAndIsMonotone, ()) {
  const double top = adc_top(1 + static_cast<int>(draw() % 24));
  const double sign = draw() % 4 == 0 ? -1.0 : 1.0;
  const double counts = sign * between(1e-12, 1e30, draw());
  std::uint8_t flag = 0;
  const auto low = static_cast<double>(digitise(counts, top, flag));
  const auto high = static_cast<double>(digitise(counts + std::abs(counts) * 0.1, top, flag));
  RC_ASSERT(low >= 0.0 && low <= top);
  RC_ASSERT(high >= low);
  RC_ASSERT(low == std::nearbyint(low));
  if (counts >= 0.0 && counts <= top) RC_ASSERT(std::abs(low - counts) <= 0.5);
}

// Fluxes, backgrounds and widths over their ranges: more light never makes the relative error worse, more background
// never better.
RC_GTEST_PROP(FluxBoundProperties, IsMonotoneInLightAndBackground, ()) {
  const auto psf = make_gaussian_psf(between(1e-3, 5.0, draw()));
  const std::vector<double> fractions = stamp(*psf, {evenly(-0.5, 0.5, draw()), 0.0}, {-10, -10, 21, 21});
  const double electrons = between(1e-3, 1e12, draw());
  const double background = between(1e-9, 1e9, draw());
  const double bound = flux_bound(fractions, {electrons, background});
  RC_ASSERT(std::isfinite(bound) && bound > 0.0);
  RC_ASSERT(bound >= std::sqrt(electrons) * (1.0 - 1e-12));
  constexpr double kRounding = 1.0 + 1e-12;
  RC_ASSERT(flux_bound(fractions, {electrons * 1.1, background}) / (electrons * 1.1) <= bound / electrons * kRounding);
  RC_ASSERT(flux_bound(fractions, {electrons, background * 1.1}) * kRounding >= bound);
}

// Means 1e-9 … nearly 1e15: whole, not negative, coupled (a larger mean never gives fewer), and near the mean.
RC_GTEST_PROP(PoissonOfAnyMeanProperties, IsWholeMonotoneAndNearItsMean, ()) {
  const double mean = between(1e-9, 9.9e14, draw());
  const std::uint64_t word = (std::uint64_t{draw()} << 32U) | draw();
  const double count = poisson_quantile(mean, word);
  RC_ASSERT(count >= 0.0 && count == std::floor(count));
  RC_ASSERT(std::abs(count - mean) <= 10.0 * std::sqrt(mean) + 40.0);
  RC_ASSERT(poisson_quantile(mean * 1.001, word) >= count);
}

}  // namespace
}  // namespace astroid
