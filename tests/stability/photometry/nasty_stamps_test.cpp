// Ten thousand random stamps that no one should have to measure: nothing crashes, no number is missing without a flag,
// and no flag is set without a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/random.hpp"
#include "astroid/photometry/centroid.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/photometry/found_stars.hpp"
#include "astroid/photometry/group_photometry.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/photometry/psf_measurement.hpp"

namespace astroid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kSigma = 1.0;  // px, of the PSF

// A sequence of uniform numbers.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : stream_(make_stream(seed, StreamId{0x57a3}, 0, 0)) {}
  double unit() { return uniform_at_step(stream_, StepAddress{.step = word_++}); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int n) { return std::min(n - 1, static_cast<int>(unit() * n)); }
  bool one_in(int n) { return below(n) == 0; }
  double normal() { return normal_at_step(stream_, StepAddress{.step = word_++}); }
  double poisson(double mean) { return poisson_at_step(stream_, StepAddress{.step = word_++}, mean); }

 private:
  RandomStream stream_;
  std::uint64_t word_ = 0;
};

struct Stamp {
  Frame frame;
  std::vector<SourceRequest> requests;
  bool clean = true;        // stars and noise, nothing else
  bool saturated = false;   // a pixel has a saturation flag
  bool bad = false;         // a pixel has no number, or a flag
  bool coincident = false;  // two requests share a place, or are near each other
};

Stamp make_stamp(std::uint64_t seed) {
  Dice dice(seed);
  Stamp stamp;
  int nx = 9 + dice.below(9);
  int ny = 9 + dice.below(9);
  if (dice.one_in(12)) nx = 1 + dice.below(3);
  if (dice.one_in(12)) ny = 1 + dice.below(3);
  const auto layout = std::make_shared<const PixelLayout>(std::vector<Rectangle>{{0, 0, nx, ny}});
  Frame& frame = stamp.frame;
  frame.pixels = Plane<float, unit::Adu>(layout);
  frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  frame.header.readout_noise = Electrons(dice.one_in(10) ? 0.0 : 5.0);
  frame.header.gain = Gain(dice.one_in(4) ? 2.5 : 1.0);
  frame.header.bias = Adu(dice.one_in(4) ? 300.0 : 0.0);
  const auto psf = make_gaussian_psf(kSigma);
  const double sky = dice.one_in(5) ? 0.0 : dice.between(1.0, 200.0);
  std::vector<double> light(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), sky);
  std::vector<double> values(light.size());
  const int stars = dice.below(4);
  for (int i = 0; i < stars; ++i) {
    PixelPosition place{dice.between(-3.0, nx + 2.0), dice.between(-3.0, ny + 2.0)};
    if (i > 0 && dice.one_in(3)) {
      place = *stamp.requests.front().pixel;
      if (dice.one_in(2)) place.x += dice.between(-0.3, 0.3);
    }
    const double flux = std::pow(10.0, dice.between(1.0, 6.0));
    psf->integrate(place, {0, 0, nx, ny}, values);
    for (std::size_t k = 0; k < light.size(); ++k) light[k] += flux * values[k];
    stamp.requests.push_back({.id = std::to_string(i), .pixel = place, .sky = {}});
  }
  const double gain = frame.header.gain.value();
  const auto pixels = frame.pixels.pixels();
  const auto flags = frame.flags.pixels();
  const double noise = dice.one_in(20) ? 0.0 : 5.0;
  for (std::size_t k = 0; k < light.size(); ++k)
    pixels[k] = static_cast<float>((dice.poisson(light[k]) + noise * dice.normal()) / gain + frame.header.bias.value());
  // Nowhere and beyond.
  if (dice.one_in(6)) {
    const double places[] = {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e9, -0.5, nx - 0.5};
    stamp.requests.push_back(
        {.id = "odd", .pixel = PixelPosition{places[dice.below(5)], dice.between(0.0, ny)}, .sky = {}});
  }
  const auto any = [&] { return static_cast<std::size_t>(dice.below(static_cast<int>(pixels.size()))); };
  switch (dice.below(14)) {
    case 0: {  // clipped and bled
      const auto level = static_cast<float>(dice.between(50.0, 3000.0) + frame.header.bias.value());
      for (std::size_t k = 0; k < pixels.size(); ++k)
        if (pixels[k] >= level) {
          pixels[k] = level;
          flags[k] = dice.one_in(2) ? pixel_flag::kFullWell : pixel_flag::kAdcSaturated;
        }
      break;
    }
    case 1:  // holes
      for (int i = 0; i < 1 + dice.below(30); ++i) pixels[any()] = kNan;
      break;
    case 2:
      std::ranges::fill(pixels, kNan);
      break;
    case 3:
      for (int i = 0; i < 1 + dice.below(5); ++i) pixels[any()] = dice.one_in(2) ? kInfinity : -kInfinity;
      break;
    case 4:
      std::ranges::fill(pixels, static_cast<float>(dice.between(-10.0, 1000.0)));
      break;
    case 5:
      std::ranges::fill(pixels, 0.0F);
      break;
    case 6:
      for (float& p : pixels) p = -p;
      break;
    case 7:  // out of all proportion
      for (int i = 0; i < 1 + dice.below(3); ++i) pixels[any()] = dice.one_in(2) ? 1e30F : -1e30F;
      break;
    case 8:  // a particle
      for (int i = 0; i < 1 + dice.below(3); ++i) pixels[any()] += static_cast<float>(dice.between(100.0, 1e5));
      break;
    case 9:
      for (int i = 0; i < 1 + dice.below(20); ++i) flags[any()] = pixel_flag::kBad;
      break;
    case 10:
      std::ranges::fill(flags, pixel_flag::kBad);
      break;
    case 11:
      for (float& p : pixels) p *= 1e-42F;  // denormal
      break;
    default:
      return stamp;
  }
  stamp.clean = false;
  return stamp;
}

// What is true of the frame, whatever is measured.
void describe(Stamp& stamp) {
  const auto pixels = stamp.frame.pixels.pixels();
  const auto flags = stamp.frame.flags.pixels();
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const unsigned f = flags[k];
    stamp.saturated = stamp.saturated || (f & (pixel_flag::kFullWell | pixel_flag::kAdcSaturated)) != 0U;
    stamp.bad = stamp.bad || (f & pixel_flag::kBad) != 0U || !(std::abs(pixels[k]) < 1e12F);
  }
  for (const SourceRequest& a : stamp.requests)
    for (const SourceRequest& b : stamp.requests)
      stamp.coincident =
          stamp.coincident || (&a != &b && std::hypot(a.pixel->x - b.pixel->x, a.pixel->y - b.pixel->y) < 6.0 * kSigma);
}

void expect_flags_with_reasons(const Stamp& stamp, const SourceMeasurement& s, int reach) {
  const Rectangle area = stamp.frame.pixels.layout().regions()[0];
  const auto has = [&](std::uint32_t flag) { return (s.flags & flag) != 0U; };
  const bool on = s.x >= area.x0 - 0.5 && s.x < area.x1() - 0.5 && s.y >= area.y0 - 0.5 && s.y < area.y1() - 0.5;
  const bool near_edge = !(s.x - reach >= area.x0 && s.x + reach <= area.x1() - 1 && s.y - reach >= area.y0 &&
                           s.y + reach <= area.y1() - 1);
  if (has(measurement_flag::kEdge)) {
    EXPECT_TRUE(near_edge);
  }
  if (has(measurement_flag::kSaturated)) {
    EXPECT_TRUE(stamp.saturated);
  }
  if (has(measurement_flag::kBadPixel)) {
    EXPECT_TRUE(stamp.bad || stamp.saturated || near_edge);
  }
  if (has(measurement_flag::kOutside)) {
    EXPECT_FALSE(on);
  }
  if (has(measurement_flag::kMerged)) {
    EXPECT_TRUE(stamp.coincident);
  }
}

void expect_no_silent_nan(const SourceMeasurement& s) {
  if (!std::isfinite(s.flux) || !std::isfinite(s.flux_err)) {
    EXPECT_NE(s.flags, 0U) << s.flux << " ± " << s.flux_err;
  }
  if (s.flags == 0U) {
    EXPECT_GE(s.flux_err, 0.0);
    EXPECT_TRUE(std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.background));
  }
  // A magnitude that is missing is that of a flux that has none.
  if (std::isnan(s.mag) && std::isfinite(s.flux) && s.flags == 0U) {
    EXPECT_LE(s.flux, 0.0);
  }
}

constexpr std::uint64_t kStamps = 10000;
constexpr int kReach = 9;  // px, more than any circle, core or group here

TEST(NastyStamps, InCirclesAndMasks) {
  ImagePhotometrySettings settings;
  settings.zero_point = Magnitude(25.0);
  for (std::uint64_t seed = 0; seed < kStamps; ++seed) {
    Stamp stamp = make_stamp(seed);
    describe(stamp);
    SCOPED_TRACE("seed " + std::to_string(seed));
    settings.method = seed % 4 == 0   ? PhotometryMethod::kPsf
                      : seed % 4 == 1 ? PhotometryMethod::kMask
                                      : PhotometryMethod::kAperture;
    settings.psf = settings.method == PhotometryMethod::kAperture ? nullptr : make_gaussian_psf(kSigma);
    settings.background = seed % 3 == 0 ? BackgroundMethod::kMesh : BackgroundMethod::kLocal;
    for (const SourceMeasurement& s : measure_image(stamp.frame, nullptr, stamp.requests, settings)) {
      expect_no_silent_nan(s);
      expect_flags_with_reasons(stamp, s, kReach);
    }
    if (HasFailure()) break;
  }
}

TEST(NastyStamps, InFitsOfGroups) {
  GroupPhotometrySettings settings;
  settings.psf = make_gaussian_psf(kSigma);
  settings.zero_point = Magnitude(25.0);
  std::size_t clean = 0;
  std::size_t doubted = 0;
  for (std::uint64_t seed = 0; seed < kStamps; ++seed) {
    Stamp stamp = make_stamp(seed);
    describe(stamp);
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const SourceMeasurement& s : measure_groups(stamp.frame, nullptr, stamp.requests, settings)) {
      expect_no_silent_nan(s);
      expect_flags_with_reasons(stamp, s, kReach);
      // Stars and noise in a frame of some size: what is in doubt is what cannot be told.
      if (!stamp.clean || stamp.coincident || !(s.snr > 10.0) || (s.flags & measurement_flag::kEdge) != 0U) continue;
      ++clean;
      doubted += (s.flags & (measurement_flag::kUnsettled | measurement_flag::kOutlier)) != 0U ? 1 : 0;
    }
    if (HasFailure()) break;
  }
  EXPECT_GT(clean, 100U);
  EXPECT_LE(doubted, clean / 50) << clean;
}

TEST(NastyStamps, InFieldsWithoutACatalogue) {
  const auto psf = make_gaussian_psf(kSigma);
  constexpr std::uint64_t kStep = 4;  // a field takes ten times as long as its circles
  for (std::uint64_t seed = 0; seed < kStamps; seed += kStep) {
    Stamp stamp = make_stamp(seed);
    describe(stamp);
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const SourceMeasurement& s : measure_field(stamp.frame, nullptr, *psf, {})) {
      expect_no_silent_nan(s);
      expect_flags_with_reasons(stamp, s, kReach);
      EXPECT_TRUE(std::isfinite(s.flux) && std::isfinite(s.flux_err) && s.flux_err > 0.0)
          << s.flux << " ± " << s.flux_err;
    }
    FoundStarsSettings find;
    for (const SourceMeasurement& s : measure_found_stars(stamp.frame, nullptr, find).sources) {
      expect_no_silent_nan(s);
      expect_flags_with_reasons(stamp, s, kReach);
    }
    if (seed % (10 * kStep) == 0) {
      try {
        (void)measure_psf(stamp.frame);
      } catch (const InputError&) {
        // Too few stars: it says so.
      }
    }
    if (HasFailure()) break;
  }
}

TEST(NastyStamps, HaveCentroidsOrFlags) {
  for (std::uint64_t seed = 0; seed < kStamps; ++seed) {
    const Stamp stamp = make_stamp(seed);
    GroupPixels pixels;
    pixels.box = stamp.frame.pixels.layout().regions()[0];
    for (const float p : stamp.frame.pixels.pixels()) pixels.electrons.push_back(static_cast<double>(p));
    pixels.variance.assign(pixels.box.size(), 25.0);
    pixels.usable.assign(pixels.box.size(), 1);
    const Centroid c = centroid_of(pixels);
    const bool known = std::isfinite(c.position.x) && std::isfinite(c.position.y);
    EXPECT_EQ(known, (c.flags & measurement_flag::kNoFlux) == 0U) << seed;
    if (known) {
      EXPECT_GE(c.position.x, -1e-9);
      EXPECT_LE(c.position.x, pixels.box.nx - 1 + 1e-9);
      EXPECT_TRUE(pixels.box.size() < 2 || c.covariance[0] >= 0.0 || (c.flags & measurement_flag::kBadPixel) != 0U)
          << seed;
    }
  }
}

}  // namespace
}  // namespace astroid
