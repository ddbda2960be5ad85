// The PSF of an image measured from its stars, where it is no Gaussian and varies over the field.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/random.hpp"
#include "astroid/photometry/background.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/photometry/phase_errors.hpp"
#include "astroid/photometry/psf_measurement.hpp"
#include "astroid/photometry/residual_image.hpp"
#include "astroid/test/star_field.hpp"

namespace astroid {
namespace {

constexpr int kSide = 512;

// Elongated along a diagonal, with a halo, and wider to the right: values on a grid of a smooth function, whose sum is
// that of one star.
EffectivePsf strange_psf() {
  EffectivePsf psf;
  psf.samples_per_pixel = 3;
  psf.half = 30;
  psf.order = 1;
  psf.field_centre = {0.5 * (kSide - 1), 0.5 * (kSide - 1)};
  psf.field_scale = {0.5 * kSide, 0.5 * kSide};
  const auto plane = [&](double sigma) {
    std::vector<double> values;
    for (int j = -psf.half; j <= psf.half; ++j)
      for (int i = -psf.half; i <= psf.half; ++i) {
        const double x = i / 3.0;
        const double y = j / 3.0;
        const double square = (x * x + y * y - 0.3 * x * y) / (sigma * sigma);
        values.push_back(std::exp(-0.5 * square) + 0.03 * std::exp(-0.5 * square / 9.0));
      }
    double sum = 0.0;
    for (const double v : values) sum += v;
    for (double& v : values) v *= 9.0 / sum;
    return values;
  };
  const std::vector<double> middle = plane(1.15);
  const std::vector<double> right = plane(1.25);
  psf.coefficients = middle;
  for (std::size_t i = 0; i < middle.size(); ++i) psf.coefficients.push_back(right[i] - middle[i]);
  psf.coefficients.resize(3 * psf.plane_size(), 0.0);
  return psf;
}

struct Scene {
  Frame frame;
  std::vector<test::TrueStar> stars;
};

Scene make_scene(const PixelPsf& psf, int count, std::uint64_t seed) {
  constexpr double kSky = 20.0;
  constexpr double kReadNoise = 5.0;
  const RandomStream places = make_stream(seed, StreamId{1}, 0, 0);
  std::uint64_t word = 0;
  const auto unit = [&] { return uniform_at_step(places, StepAddress{.step = word++}); };
  Scene scene;
  std::vector<double> light(static_cast<std::size_t>(kSide) * kSide, kSky);
  std::vector<double> stamp;
  for (int n = 0; n < count; ++n) {
    test::TrueStar star;
    star.flux = 300.0 * std::pow(10.0, 2.3 * unit());
    star.x = unit() * kSide - 0.5;
    star.y = unit() * kSide - 0.5;
    scene.stars.push_back(star);
    const Rectangle all{0, 0, kSide, kSide};
    const Rectangle box = intersect(stamp_box({star.x, star.y}, 11.0), all);
    stamp.resize(box.size());
    psf.integrate({star.x, star.y}, box, stamp);
    std::size_t k = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x, ++k)
        light[static_cast<std::size_t>(y * kSide + x)] += star.flux * stamp[k];
  }
  const auto layout = std::make_shared<const PixelLayout>(std::vector<Rectangle>{{0, 0, kSide, kSide}});
  scene.frame.pixels = Plane<float, unit::Adu>(layout);
  scene.frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  scene.frame.header.readout_noise = Electrons(kReadNoise);
  const RandomStream noise = make_stream(seed, StreamId{2}, 0, 0);
  for (std::size_t i = 0; i < light.size(); ++i)
    scene.frame.pixels.pixels()[i] =
        static_cast<float>(poisson_at_step(noise, StepAddress{.step = 2 * i}, light[i]) +
                           kReadNoise * normal_at_step(noise, StepAddress{.step = 2 * i + 1}));
  return scene;
}

struct Errors {
  std::vector<double> relative;
  double bright_scatter = 0.0;  // robust, of the bright half
  double median = 0.0;
  double pull = 0.0;
};

Errors compare(const Scene& scene, const std::vector<SourceMeasurement>& sources) {
  constexpr double kBright = 8000.0;  // e-
  Errors errors;
  std::vector<double> pulls;
  for (const test::TrueStar& star : scene.stars) {
    if (star.flux < kBright || std::min(star.x, star.y) < 8 || std::max(star.x, star.y) > kSide - 9) continue;
    for (const SourceMeasurement& s : sources) {
      if (std::hypot(s.x - star.x, s.y - star.y) > 0.5) continue;
      errors.relative.push_back(s.flux / star.flux - 1.0);
      pulls.push_back((s.flux - star.flux) / s.flux_err);
      break;
    }
  }
  const auto middle = [](std::vector<double> v) {
    const auto m = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), m, v.end());
    return *m;
  };
  errors.median = middle(errors.relative);
  std::vector<double> away;
  for (const double e : errors.relative) away.push_back(std::abs(e - errors.median));
  errors.bright_scatter = 1.4826 * middle(away);
  away.clear();
  for (const double p : pulls) away.push_back(std::abs(p));
  errors.pull = 1.4826 * middle(away);
  return errors;
}

TEST(MeasuredPsf, MeasuresAPsfThatIsNoGaussianAndVaries) {
  const auto truth = make_effective_psf(strange_psf());
  const Scene scene = make_scene(*truth, 900, 5);
  const MeasuredPsf measured = measure_psf(scene.frame);
  EXPECT_GE(measured.psf.order, 1);
  EXPECT_GT(measured.stars, 150U);
  const auto psf = make_effective_psf(measured.psf);
  FieldPhotometrySettings settings;
  const Errors best = compare(scene, measure_field(scene.frame, nullptr, *truth, settings));
  settings.psf_error = measured.flux_error;
  const Errors ours = compare(scene, measure_field(scene.frame, nullptr, *psf, settings));
  const auto n = static_cast<double>(ours.relative.size());
  ASSERT_GT(n, 100.0);
  // A circular Gaussian of the right width is wrong by some per cent, another one to the left than to the right.
  EXPECT_LT(ours.bright_scatter, 1.2 * best.bright_scatter);
  EXPECT_NEAR(ours.median, 0.0, 0.0026 + 2.0 * 1.2533 * ours.bright_scatter / std::sqrt(n));
  EXPECT_NEAR(ours.pull, 1.0, 0.13 + 2.0 * 1.17 / std::sqrt(n));
  EXPECT_LT(measured.flux_error, 0.005);
}

TEST(MeasuredPsf, IsWiderWhereTheTruthIs) {
  const auto truth = make_effective_psf(strange_psf());
  const Scene scene = make_scene(*truth, 900, 6);
  const auto psf = make_effective_psf(measure_psf(scene.frame).psf);
  for (const double x : {60.0, 256.0, 450.0}) {
    const Rectangle box{static_cast<int>(x), 256, 1, 1};
    double expected[1];
    double ours[1];
    truth->integrate({x, 256.0}, box, expected);
    psf->integrate({x, 256.0}, box, ours);
    // The truth's peak falls by 16 % over this range.
    EXPECT_NEAR(ours[0] / expected[0], 1.0, 0.01) << x;
  }
}

TEST(MeasuredPsf, LeavesNoPatternWithinPixels) {
  const test::StarFieldSettings settings{.stars = 750, .fwhm = 1.3, .slope = 0.15, .seed = 9};
  const test::StarField field = test::make_star_field(settings);
  const MeasuredPsf measured = measure_psf(field.frame);
  const BackgroundMap background(field.frame, 0, {});
  const auto worst = [&](const PixelPsf& psf) {
    const auto sources = measure_field(field.frame, nullptr, psf, {});
    const auto left = residual_image(field.frame, background, sources, psf);
    double chi2 = 0.0;
    const auto errors = phase_errors(left, Gain(1.0), background.median_rms(), sources, psf, 4);
    for (const PhaseError& e : errors)
      if (e.stars > 0) chi2 += e.residual * e.residual / (e.residual_error * e.residual_error);
    return chi2 / static_cast<double>(errors.size());
  };
  EXPECT_LT(worst(*make_effective_psf(measured.psf)), 2.0);
  // Half a tenth of a pixel too wide shows.
  EXPECT_GT(worst(*make_gaussian_psf(1.3 / 2.3548 + 0.05)), 10.0);
}

TEST(MeasuredPsf, IsTheSameAgain) {
  const test::StarField field = test::make_star_field({.nx = 256, .ny = 256, .stars = 300, .slope = 0.1, .seed = 2});
  EXPECT_EQ(measure_psf(field.frame).psf.coefficients, measure_psf(field.frame).psf.coefficients);
}

TEST(MeasuredPsf, SaysWhenThereAreNotEnoughStars) {
  test::StarField field = test::make_star_field({.nx = 128, .ny = 128, .stars = 0});
  EXPECT_THROW(measure_psf(field.frame), InputError);
  for (float& value : field.frame.pixels.pixels()) value = 3.0F;
  EXPECT_THROW(measure_psf(field.frame), InputError);
  for (float& value : field.frame.pixels.pixels()) value = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(measure_psf(field.frame), InputError);
  PsfMeasurementSettings settings;
  settings.rounds = 0;
  EXPECT_THROW(measure_psf(field.frame, settings), InputError);
}

}  // namespace
}  // namespace astroid
