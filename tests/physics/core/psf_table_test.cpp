// What stands between a tabulated PSF and the truth: how it was sampled, the spline, and the phase library.
#include "astroid/test/psf_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

std::vector<double> render(const PixelPsf& psf, PixelPosition star, Rectangle box) {
  std::vector<double> fractions(box.size());
  psf.integrate(star, box, fractions);
  return fractions;
}

double aperture_flux(const PixelPsf& psf, PixelPosition star) {
  const auto p = render(psf, star, {-1, -1, 3, 3});
  return std::accumulate(p.begin(), p.end(), 0.0);
}

struct Errors {
  double rms, worst;  // relative
};

// Flux errors in 3 x 3 pixels over a lattice of star positions in the central pixel that meets no phase.
Errors aperture_errors(const PixelPsf& psf, const PixelPsf& truth) {
  constexpr int kPositions = 37;
  Errors errors{};
  double sum = 0.0;
  for (int j = 0; j < kPositions; ++j) {
    for (int i = 0; i < kPositions; ++i) {
      const PixelPosition star{(i + 0.5) / kPositions - 0.5, (j + 0.5) / kPositions - 0.5};
      const double error = aperture_flux(psf, star) / aperture_flux(truth, star) - 1.0;
      sum += error * error;
      errors.worst = std::max(errors.worst, std::abs(error));
    }
  }
  errors.rms = std::sqrt(sum / (kPositions * kPositions));
  return errors;
}

/// Largest error in any square of 2 or 3 px of a star's image, relative to the star: what a renderer states of itself.
double error_anywhere(const PixelPsf& psf, const PixelPsf& truth) {
  constexpr int kPositions = 37;
  constexpr Rectangle kBox{-5, -5, 11, 11};
  double worst = 0.0;
  for (int j = 0; j < kPositions; ++j)
    for (int i = 0; i < kPositions; ++i) {
      const PixelPosition star{(i + 0.5) / kPositions - 0.5, (j + 0.5) / kPositions - 0.5};
      const std::vector<double> made = render(psf, star, kBox);
      const std::vector<double> exact = render(truth, star, kBox);
      for (const int side : {2, 3})
        for (int y = 0; y + side <= kBox.ny; ++y)
          for (int x = 0; x + side <= kBox.nx; ++x) {
            double error = 0.0;
            for (int b = y; b < y + side; ++b)
              for (int a = x; a < x + side; ++a) {
                const auto pixel = static_cast<std::size_t>(b * kBox.nx + a);
                error += made[pixel] - exact[pixel];
              }
            worst = std::max(worst, std::abs(error));
          }
    }
  return worst;
}

struct Case {
  int phases;
  double sigma, rms, worst;  // ppm
};

TEST(PhaseLibrary, HasTheErrorsThatWereMeasuredIndependently) {
  for (const Case& c : {Case{8, 0.5, 20.1, 30.5}, Case{8, 0.6, 12.2, 23.2}, Case{8, 1.0, 2.95, 4.68},
                        Case{16, 0.5, 1.29, 1.95}, Case{16, 0.6, 0.76, 1.58}, Case{16, 1.0, 0.19, 0.32},
                        Case{32, 0.5, 0.081, 0.12}, Case{32, 0.6, 0.050, 0.095}, Case{32, 1.0, 0.012, 0.020}}) {
    // 64 samples per pixel: the spline is not in the way.
    const PsfAccuracy of_the_star(1.0, 1.0);
    const auto psf = make_prf_psf(test::gaussian_psf_table(c.sigma, 64.0, 6.0), of_the_star, c.phases);
    const Errors errors = aperture_errors(*psf, *make_gaussian_psf(c.sigma));
    constexpr double kFactor = 1.5;
    EXPECT_LT(1e6 * errors.rms, c.rms * kFactor) << c.phases << " phases, sigma " << c.sigma;
    EXPECT_GT(1e6 * errors.rms, c.rms / kFactor) << c.phases << " phases, sigma " << c.sigma;
    EXPECT_LT(1e6 * errors.worst, c.worst * kFactor) << c.phases << " phases, sigma " << c.sigma;
    EXPECT_GT(1e6 * errors.worst, c.worst / kFactor) << c.phases << " phases, sigma " << c.sigma;
    // What the renderer says of itself is the worst there is, in squares of 2 px too and wherever they lie.
    EXPECT_GT(psf->approximation_error(), 0.7 * errors.worst);
    EXPECT_LT(psf->approximation_error(), 2.0 * error_anywhere(*psf, *make_gaussian_psf(c.sigma)));
  }
}

TEST(PhaseLibrary, KeepsTheAccuracyAskedFor) {
  for (const double accuracy : {1e-4, 1e-6, 1e-8}) {
    const auto psf = make_prf_psf(test::gaussian_psf_table(0.6, 16.0, 4.0), accuracy);
    EXPECT_LE(psf->approximation_error(), accuracy);
    EXPECT_GT(psf->approximation_error(), accuracy / 100.0);  // and is not much better, which would cost memory
  }
}

TEST(PsfTable, OfExactFluxesIsAsGoodAsItsSpline) {
  // The fourth-order error of a cubic spline, falling sixteen-fold with every doubling.
  const auto truth = make_gaussian_psf(0.6);
  const Errors coarse = aperture_errors(*make_prf_psf(test::gaussian_psf_table(0.6, 4.0, 5.0), 1e-9), *truth);
  const Errors middle = aperture_errors(*make_prf_psf(test::gaussian_psf_table(0.6, 8.0, 5.0), 1e-9), *truth);
  const Errors fine = aperture_errors(*make_prf_psf(test::gaussian_psf_table(0.6, 16.0, 5.0), 1e-9), *truth);
  EXPECT_LT(1e6 * middle.rms, 30.0);
  EXPECT_LT(1e6 * fine.rms, 2.0);
  EXPECT_GT(coarse.rms / middle.rms, 8.0);
  EXPECT_GT(middle.rms / fine.rms, 8.0);
}

TEST(PsfTable, OfPointValuesIsNarrowerByTheVarianceOfASample) {
  // Point values taken for the means over samples of width h make a PSF whose mean over h is the Gaussian: its variance
  // is smaller by h^2 / 12. That error is the table's, not the renderer's.
  for (const double sigma : {0.6, 0.8, 1.0}) {
    for (const double per_pixel : {8.0, 16.0}) {
      const auto psf = make_prf_psf(test::sampled_gaussian_psf_table(sigma, per_pixel, 7.0), 1e-8);
      const double narrower = std::sqrt(sigma * sigma - 1.0 / (12.0 * per_pixel * per_pixel));
      const Errors as_it_is = aperture_errors(*psf, *make_gaussian_psf(narrower));
      const Errors as_meant = aperture_errors(*psf, *make_gaussian_psf(sigma));
      EXPECT_LT(as_it_is.worst, 6e-5 * std::pow(8.0 / per_pixel, 4) * std::pow(0.6 / sigma, 4));
      EXPECT_GT(as_meant.rms, 10.0 * as_it_is.rms);
    }
  }
}

TEST(PsfTable, ThatIsSymmetricGivesSymmetricStamps) {
  const auto psf = make_prf_psf(test::gaussian_psf_table(0.7, 9.0, 4.0), 1e-6);
  constexpr double kRounding = 1e-15;
  for (const PixelPosition star : {PixelPosition{0.0, 0.0}, PixelPosition{0.5, 0.5}}) {
    const int n = star.x == 0.0 ? 13 : 14;
    const auto p = render(*psf, star, {-6, -6, n, n});
    const auto at = [&](int i, int j) { return p[static_cast<std::size_t>(j * n + i)]; };
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(at(i, j), at(n - 1 - i, j), kRounding);
        EXPECT_NEAR(at(i, j), at(i, n - 1 - j), kRounding);
        EXPECT_NEAR(at(i, j), at(j, i), kRounding);
      }
    }
  }
  // Mirrored about the pixel's centre the star at +0.3 is the star at -0.3.
  const auto right = render(*psf, {0.3, 0.1}, {-6, -6, 13, 13});
  auto left = render(*psf, {-0.3, -0.1}, {-6, -6, 13, 13});
  std::reverse(left.begin(), left.end());
  for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(right[i], left[i], kRounding);
}

TEST(PsfTable, IsZeroBeyondItsEdge) {
  const auto psf = make_prf_psf(test::gaussian_psf_table(0.6, 8.0, 3.0), 1e-6);
  const auto p = render(*psf, {0.2, 0.2}, {-100, -100, 201, 201});
  for (int y = -100; y <= 100; ++y) {
    for (int x = -100; x <= 100; ++x) {
      const double value = p[static_cast<std::size_t>((y + 100) * 201 + x + 100)];
      const bool outside = std::abs(x) > 5 || std::abs(y) > 5;
      EXPECT_TRUE(!outside || value == 0.0) << x << " " << y;
    }
  }
  EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-14);
}

TEST(PsfTable, KeepsTheFluxOfASampleThatFillsAPixel) {
  // One sample per pixel and a star in a pixel's centre: the stamp is the table, whatever it looks like.
  PsfTable table;
  table.samples = Image<double, unit::Relative>(5, 4);
  std::iota(table.samples.pixels().begin(), table.samples.pixels().end(), 1.0);
  table.samples_per_pixel = 1.0;
  table.centre_x = 2.0;
  table.centre_y = 1.0;
  const auto psf = make_prf_psf(table, 1.0, 4);
  const auto p = render(*psf, {10.0, 20.0}, {8, 19, 5, 4});
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], static_cast<double>(i + 1) / 210.0, 1e-15);
}

TEST(PsfTable, NormalisesAnyScale) {
  PsfTable table = test::gaussian_psf_table(0.6, 8.0, 4.0);
  const auto unit = render(*make_prf_psf(table, 1e-6), {0.1, 0.2}, {-3, -3, 7, 7});
  for (double& value : table.samples.pixels()) value *= 1024.0;
  const auto scaled = render(*make_prf_psf(table, 1e-6), {0.1, 0.2}, {-3, -3, 7, 7});
  EXPECT_EQ(unit, scaled);
}

}  // namespace
}  // namespace astroid
