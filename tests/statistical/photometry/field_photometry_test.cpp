// Blind photometry of a crowded field: what is found, and whether the errors are honest.
#include "astroid/photometry/field_photometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"

namespace astroid {
namespace {

struct TrueStar {
  double x, y, flux;
};

// A generator of its own: erf by libm, numbers by the standard library.
Frame make_field(int side, int count, double sigma, std::vector<TrueStar>& stars, unsigned seed) {
  // Words of a stream, one after the other; what is drawn from them needs no more than quantiles.
  const RandomStream places = make_stream(seed, StreamId{1}, 0, 0);
  std::uint64_t word = 0;
  const auto unit = [&] { return uniform_at_step(places, StepAddress{.step = word++}); };
  const auto place = [&] { return unit() * side - 0.5; };
  constexpr double kSky = 20.0;       // e-/px
  constexpr double kReadNoise = 5.0;  // e-
  std::vector<double> light(static_cast<std::size_t>(side * side), kSky);
  const double k = 1.0 / (std::sqrt(2.0) * sigma);
  const auto share = [k](double u, int i) { return 0.5 * (std::erf((i + 0.5 - u) * k) - std::erf((i - 0.5 - u) * k)); };
  for (int n = 0; n < count; ++n) {
    // Counts ∝ 10^(0.25 mag) from 12.5 to 20.5.
    const double low = std::pow(10.0, 0.25 * 12.5);
    const double high = std::pow(10.0, 0.25 * 20.5);
    const double mag = std::log10(low + unit() * (high - low)) / 0.25;
    const TrueStar star{place(), place(), std::pow(10.0, 0.4 * (25.0 - mag))};
    stars.push_back(star);
    const int reach = static_cast<int>(std::ceil(9.0 * sigma));
    const int x0 = static_cast<int>(std::lround(star.x));
    const int y0 = static_cast<int>(std::lround(star.y));
    for (int y = std::max(0, y0 - reach); y <= std::min(side - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(side - 1, x0 + reach); ++x)
        light[static_cast<std::size_t>(y * side + x)] += star.flux * share(star.x, x) * share(star.y, y);
  }
  const auto layout = std::make_shared<const PixelLayout>(std::vector<Rectangle>{{0, 0, side, side}});
  Frame frame;
  frame.pixels = Plane<float, unit::Adu>(layout);
  frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  frame.header.readout_noise = Electrons(kReadNoise);
  const RandomStream noise = make_stream(seed, StreamId{2}, 0, 0);
  for (std::size_t i = 0; i < light.size(); ++i) {
    const std::uint64_t step = 2 * i;
    frame.pixels.pixels()[i] = static_cast<float>(poisson_at_step(noise, StepAddress{.step = step}, light[i]) +
                                                  kReadNoise * normal_at_step(noise, StepAddress{.step = step + 1}));
  }
  return frame;
}

TEST(FieldPhotometry, MeasuresACrowdWithHonestErrors) {
  constexpr int kSide = 512;
  constexpr double kSigma = 2.5 / 2.3548200450309493;
  std::vector<TrueStar> truth;
  const Frame frame = make_field(kSide, 3750, kSigma, truth, 11);
  const auto psf = make_gaussian_psf(kSigma);
  const std::vector<SourceMeasurement> sources = measure_field(frame, nullptr, *psf, {});
  std::sort(truth.begin(), truth.end(), [](const TrueStar& a, const TrueStar& b) { return a.flux > b.flux; });
  std::vector<char> used(sources.size(), 0);
  std::vector<double> pull;
  int bright = 0;
  int found = 0;
  for (const TrueStar& star : truth) {
    constexpr double kCut = 8.0;  // px
    if (std::min(star.x, star.y) < kCut || std::max(star.x, star.y) > kSide - 1 - kCut) continue;
    std::size_t best = sources.size();
    double nearest = 1.0;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const double d = std::hypot(sources[i].x - star.x, sources[i].y - star.y);
      if (used[i] == 0 && d < nearest) {
        nearest = d;
        best = i;
      }
    }
    const bool hit = best < sources.size();
    if (hit) used[best] = 1;
    constexpr double kFaintest = 1000.0;  // e-: 24 sigma alone
    if (star.flux < kFaintest) continue;
    ++bright;
    if (!hit || std::abs(std::log10(sources[best].flux / star.flux)) > 0.3) continue;
    ++found;
    pull.push_back((sources[best].flux - star.flux) / sources[best].flux_err);
  }
  // Pairs closer than a resolvable distance, about 0.3 FWHM, are one star: a per cent of them at this density.
  EXPECT_GT(found, 0.97 * bright) << found << " of " << bright;
  std::sort(pull.begin(), pull.end());
  const double median = pull[pull.size() / 2];
  std::vector<double> deviation;
  for (const double p : pull) deviation.push_back(std::abs(p - median));
  std::nth_element(deviation.begin(), deviation.begin() + static_cast<std::ptrdiff_t>(deviation.size() / 2),
                   deviation.end());
  const double width = 1.4826 * deviation[deviation.size() / 2];
  // The bar is 0.1; the median absolute deviation of n normal values scatters by 0.82 / sqrt(n).
  EXPECT_NEAR(width, 1.0, 0.1 + 2.0 * 0.82 / std::sqrt(static_cast<double>(pull.size())));
}

TEST(FieldPhotometry, FindsNothingInNothing) {
  std::vector<TrueStar> none;
  const auto psf = make_gaussian_psf(1.0);
  Frame frame = make_field(64, 0, 1.0, none, 3);
  EXPECT_LE(measure_field(frame, nullptr, *psf, {}).size(), 1U);
  for (float& value : frame.pixels.pixels()) value = 7.0F;
  EXPECT_TRUE(measure_field(frame, nullptr, *psf, {}).empty());
  for (float& value : frame.pixels.pixels()) value = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(measure_field(frame, nullptr, *psf, {}).empty());
}

}  // namespace
}  // namespace astroid
