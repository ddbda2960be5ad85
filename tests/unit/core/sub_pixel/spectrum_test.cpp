#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/psf_spectrum.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"

namespace astroid {
namespace {

using Complex = std::complex<double>;

// A table without any symmetry, whose origin is nowhere in particular and whose border is not dark.
PsfTable lopsided_table() {
  PsfTable table;
  table.samples = Image<double, unit::Relative>(9, 7);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x)
      table.samples.at(x, y) = 1.0 / (1.0 + (x - 4.3) * (x - 4.3) + 2.0 * (y - 2.8) * (y - 2.8)) + 0.01 * ((x * y) % 3);
  table.samples_per_pixel = 2.3;
  table.centre_x = 3.9;
  table.centre_y = 3.2;
  return table;
}

TEST(PsfSpectrum, OfATableIsTheFourierTransformOfItsSurfaceBrightness) {
  const PsfTable table = lopsided_table();
  const auto brightness = test::table_brightness(table);
  const std::vector<double> kx = {0.0, 1e-5, 0.3, 1.7};
  const std::vector<double> ky = {-2.1, 0.0, 0.4};
  std::vector<Complex> h(kx.size() * ky.size());
  make_table_spectrum(table)->sample(kx, ky, h);
  const long double two_pi = 2.0L * std::acos(-1.0L);
  const test::Area everywhere{brightness.x_breaks.front(), brightness.x_breaks.back(), brightness.y_breaks.front(),
                              brightness.y_breaks.back()};
  for (std::size_t q = 0; q < ky.size(); ++q)
    for (std::size_t i = 0; i < kx.size(); ++i) {
      const auto part = [&](bool real) {
        test::SurfaceBrightness wave = brightness;
        wave.density = [&](long double dx, long double dy) {
          const long double angle =
              -two_pi * (static_cast<long double>(kx[i]) * dx + static_cast<long double>(ky[q]) * dy);
          return brightness.density(dx, dy) * (real ? std::cos(angle) : std::sin(angle));
        };
        return static_cast<double>(test::integrate_area(wave, {0.0, 0.0}, everywhere, 1e-13L).value);
      };
      EXPECT_NEAR(h[q * kx.size() + i].real(), part(true), 1e-13) << kx[i] << " " << ky[q];
      EXPECT_NEAR(h[q * kx.size() + i].imag(), part(false), 1e-13) << kx[i] << " " << ky[q];
    }
}

double cosine_transform(const test::SurfaceBrightness& brightness, double kx, double ky) {
  const long double two_pi = 2.0L * std::acos(-1.0L);
  test::SurfaceBrightness wave = brightness;
  wave.density = [&](long double dx, long double dy) {
    return brightness.density(dx, dy) *
           std::cos(two_pi * (static_cast<long double>(kx) * dx + static_cast<long double>(ky) * dy));
  };
  const long double reach = brightness.x_breaks.back();
  return static_cast<double>(test::integrate_area(wave, {0.0, 0.0}, {-reach, reach, -reach, reach}, 2e-13L).value);
}

TEST(CircularSpectrum, IsTheFourierTransformOfTheFadedLight) {
  const std::vector<double> k = {0.2, 1.3};
  std::vector<Complex> h(k.size() * k.size());
  const auto expect = [&](const PsfSpectrum& spectrum, const test::SurfaceBrightness& brightness) {
    spectrum.sample(k, k, h);
    for (std::size_t q = 0; q < k.size(); ++q)
      for (std::size_t i = 0; i < k.size(); ++i) {
        EXPECT_NEAR(h[q * k.size() + i].real(), cosine_transform(brightness, k[i], k[q]), 1e-12) << k[i] << " " << k[q];
        EXPECT_EQ(h[q * k.size() + i].imag(), 0.0);
      }
  };
  expect(*make_moffat_spectrum(1.4, 2.5, {.reach = 3}), test::faded_brightness(test::moffat_density(1.4L, 2.5L), 3.0L));
  expect(*make_airy_spectrum(0.9, 0.3, {.reach = 3}), test::faded_brightness(test::airy_density(0.9L, 0.3L), 3.0L));
}

// Of the whole Moffat profile: 2 (pi alpha k)^(beta - 1) K_(beta - 1)(2 pi alpha k) / Gamma(beta - 1).
TEST(CircularSpectrum, OfAMoffatProfileIsABesselFunction) {
  constexpr double kFwhm = 1.6;
  constexpr double kBeta = 4.5;
  const double alpha = 0.5 * kFwhm / std::sqrt(std::pow(2.0, 1.0 / kBeta) - 1.0);
  const std::vector<double> kx = {0.05, 0.4, 1.0};
  const std::vector<double> ky = {0.0, 0.3};
  std::vector<Complex> h(kx.size() * ky.size());
  make_moffat_spectrum(kFwhm, kBeta, {.reach = 90})->sample(kx, ky, h);
  // What lies beyond where the light fades: (r/alpha)^(2 - 2 beta).
  const double beyond = std::pow(84.0 / alpha, 2.0 - 2.0 * kBeta);
  ASSERT_LT(beyond, 1e-11);
  for (std::size_t q = 0; q < ky.size(); ++q)
    for (std::size_t i = 0; i < kx.size(); ++i) {
      const double z = std::acos(-1.0) * alpha * std::hypot(kx[i], ky[q]);
      const double exact =
          2.0 * std::pow(z, kBeta - 1.0) * std::cyl_bessel_k(kBeta - 1.0, 2.0 * z) / std::tgamma(kBeta - 1.0);
      EXPECT_NEAR(h[q * kx.size() + i].real(), exact, beyond + 1e-12);
    }
}

// The modulation transfer function of a round aperture without obscuration: (2/pi)(acos v - v sqrt(1 - v²)).
TEST(CircularSpectrum, OfAnAiryPatternNearsItsModulationTransferFunction) {
  constexpr double kLambdaOverD = 0.5;
  const std::vector<double> kx = {0.2, 1.0, 1.7, 2.3};
  const std::vector<double> ky = {0.5};
  std::vector<Complex> h(kx.size());
  make_airy_spectrum(kLambdaOverD, 0.0, {.reach = 90})->sample(kx, ky, h);
  const double pi = std::acos(-1.0);
  for (std::size_t i = 0; i < kx.size(); ++i) {
    const double v = kLambdaOverD * std::hypot(kx[i], ky[0]);
    const double exact = v < 1.0 ? 2.0 / pi * (std::acos(v) - v * std::sqrt(1.0 - v * v)) : 0.0;
    // 2 / (pi² r / (lambda/D)) of the light lies beyond where it fades.
    EXPECT_NEAR(h[i].real(), exact, 2.0 / (pi * pi * 84.0 / kLambdaOverD)) << kx[i];
  }
}

TEST(CircularSpectrum, OfDiffusedLightIsTheProduct) {
  constexpr double kDiffusion = 0.3;
  const std::vector<double> k = {0.0, 0.25, 0.9};
  std::vector<Complex> sharp(k.size() * k.size());
  std::vector<Complex> diffused(sharp.size());
  make_moffat_spectrum(1.4, 5.0, {.reach = 60})->sample(k, k, sharp);
  make_moffat_spectrum(1.4, 5.0, {.reach = 60, .diffusion = kDiffusion})->sample(k, k, diffused);
  const double pi = std::acos(-1.0);
  for (std::size_t q = 0; q < k.size(); ++q)
    for (std::size_t i = 0; i < k.size(); ++i) {
      const double blur = std::exp(-2.0 * pi * pi * kDiffusion * kDiffusion * (k[i] * k[i] + k[q] * k[q]));
      EXPECT_NEAR(diffused[q * k.size() + i].real(), sharp[q * k.size() + i].real() * blur, 1e-12);
    }
}

TEST(PsfSpectrum, OfAGaussianIsAGaussian) {
  const std::vector<double> k = {0.0, 0.5};
  std::vector<Complex> h(4);
  make_gaussian_spectrum(0.6)->sample(k, k, h);
  EXPECT_EQ(h[0], Complex(1.0));
  const double expected = std::exp(-2.0 * std::acos(-1.0) * std::acos(-1.0) * 0.36 * 0.25);
  EXPECT_NEAR(h[1].real(), expected, 1e-15);
  EXPECT_NEAR(h[3].real(), expected * expected, 1e-15);
}

TEST(PsfSpectrum, KnowsWhatABandLeavesOut) {
  // A table finer than its spline matters is the Gaussian, so its measurement must stay below the bound, not far below.
  for (const double sigma : {0.5, 0.8}) {
    const auto bound = make_gaussian_spectrum(sigma);
    const auto measured = make_table_spectrum(test::gaussian_psf_table(sigma, 24.0, 7.0 * sigma));
    for (const double band : {0.4, 0.6, 0.8}) {
      // Its frequencies come in steps of 1/19 px or more.
      constexpr double kStep = 1.0 / 19.0;
      EXPECT_LT(measured->error_beyond(band / sigma), bound->error_beyond(band / sigma - kStep))
          << sigma << " " << band;
      EXPECT_GT(measured->error_beyond(band / sigma), 0.2 * bound->error_beyond(band / sigma)) << sigma << " " << band;
    }
  }
}

TEST(PsfSpectrum, RefusesAPointAndWhatIsNoWidth) {
  for (const double sigma : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(make_gaussian_spectrum(sigma), InputError);
}

}  // namespace
}  // namespace astroid
