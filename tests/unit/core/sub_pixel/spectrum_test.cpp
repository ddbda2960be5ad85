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
