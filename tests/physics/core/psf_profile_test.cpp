// Moffat and Airy PSFs against adaptive quadrature in long double, and charge diffusion.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"

namespace astroid {
namespace {

constexpr long double kPiLong = 3.14159265358979323846264338327950288L;

/// Of a PSF whose wings end at `reach` px.
test::Density moffat_density(long double fwhm, long double beta, int reach = PsfWings{}.reach) {
  return test::faded_brightness(test::moffat_density(fwhm, beta), reach).density;
}
test::Density airy_density(long double lambda_over_d, long double obscuration, int reach = PsfWings{}.reach) {
  return test::faded_brightness(test::airy_density(lambda_over_d, obscuration), reach).density;
}

long double square_flux(const test::Density& density, long double x0, long double x1, long double y0, long double y1,
                        long double relative) {
  return test::integrate(
      [&](long double y) { return test::integrate([&](long double x) { return density(x, y); }, x0, x1, relative); },
      y0, y1, relative);
}

std::vector<double> render(const PixelPsf& psf, PixelPosition star, Rectangle box) {
  std::vector<double> fractions(box.size());
  psf.integrate(star, box, fractions);
  return fractions;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void expect_quadrature(const PixelPsf& psf, const test::Density& density, double accuracy) {
  EXPECT_LE(psf.approximation_error(), 2.0 * accuracy);  // of core and wings
  for (const PixelPosition star : {PixelPosition{0.0, 0.0}, {0.37, -0.21}, {0.5, 0.5}, {-0.119, 0.443}}) {
    const double exact = static_cast<double>(
        square_flux(density, -1.5L - static_cast<long double>(star.x), 1.5L - static_cast<long double>(star.x),
                    -1.5L - static_cast<long double>(star.y), 1.5L - static_cast<long double>(star.y), 1e-13L));
    EXPECT_NEAR(sum_of(render(psf, star, {-1, -1, 3, 3})) / exact, 1.0, 1.5 * accuracy) << star.x << " " << star.y;
    // Single pixels, near and far, on both sides of the border between core and wings.
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{1, 2}, std::pair{5, 0}, std::pair{7, 6}, std::pair{-8, 3},
                               std::pair{12, -9}, std::pair{-17, -17}}) {
      const double pixel = static_cast<double>(test::integrate_pixel(density, star, x, y, 1e-13L));
      EXPECT_NEAR(render(psf, star, {x, y, 1, 1})[0], pixel, 3.0 * accuracy) << x << " " << y;
    }
  }
}

TEST(Moffat, HasTheFluxOfAdaptiveQuadrature) {
  for (const double accuracy : {1e-5, 4e-7})
    for (const double beta : {1.5, 2.5, 4.765})
      expect_quadrature(*make_moffat_psf(1.4, beta, {}, accuracy), moffat_density(1.4L, static_cast<long double>(beta)),
                        accuracy);
  expect_quadrature(*make_moffat_psf(0.7, 3.0, {}, 4e-7), moffat_density(0.7L, 3.0L), 4e-7);
}

TEST(Airy, HasTheFluxOfAdaptiveQuadrature) {
  for (const double accuracy : {1e-5, 4e-7})
    for (const double obscuration : {0.0, 0.35})
      expect_quadrature(*make_airy_psf(1.5, obscuration, {}, accuracy),
                        airy_density(1.5L, static_cast<long double>(obscuration)), accuracy);
  expect_quadrature(*make_airy_psf(0.8, 0.2, {}, 4e-7), airy_density(0.8L, 0.2L), 4e-7);
}

TEST(Moffat, IsNormalisedOnInfiniteSupport) {
  constexpr int kReach = 12;
  const double inside =
      sum_of(render(*make_moffat_psf(1.4, 2.5, {.reach = kReach}, 1e-6), {0.0, 0.0}, {-15, -15, 31, 31}));
  const test::Density density = moffat_density(1.4L, 2.5L, kReach);
  const double exact = static_cast<double>(
      test::integrate([&](long double r) { return 2.0L * kPiLong * r * density(r, 0.0L); }, 0.0L, kReach, 1e-12L));
  EXPECT_NEAR(inside, exact, 2e-7);
  EXPECT_LT(exact, 0.9995);
  // Outside a circle falls (1 + r²/alpha²)^(1-beta): between where the light fades and where it ends.
  const double alpha2 = 0.49 / (std::pow(2.0, 1.0 / 2.5) - 1.0);
  constexpr double kFades = kReach - 6.0;
  EXPECT_LT(1.0 - inside, std::pow(1.0 + kFades * kFades / alpha2, -1.5));
  EXPECT_GT(1.0 - inside, std::pow(1.0 + kReach * kReach / alpha2, -1.5));
}

TEST(Airy, IsNormalisedOnInfiniteSupport) {
  // The oracle's own normalisation: a circle of radius r holds 1 - J0² - J1².
  const test::Density density = test::airy_density(1.5L, 0.0L);
  for (const long double r : {1.0L, 3.0L, 10.0L}) {
    const long double inside =
        test::integrate([&](long double s) { return 2.0L * kPiLong * s * density(s, 0.0L); }, 0.0L, r, 1e-14L);
    const long double v = kPiLong * r / 1.5L;
    const long double j0 = std::cyl_bessel_j(0.0L, v);
    const long double j1 = std::cyl_bessel_j(1.0L, v);
    EXPECT_NEAR(static_cast<double>(inside / (1.0L - j0 * j0 - j1 * j1)), 1.0, 1e-12);
  }
  for (const double obscuration : {0.0, 0.5}) {
    constexpr int kReach = 30;
    const double inside =
        sum_of(render(*make_airy_psf(1.5, obscuration, {.reach = kReach}, 1e-6), {0.0, 0.0}, {-33, -33, 67, 67}));
    // About 2 / (pi² (1 - e) r) lies outside a circle; the light fades over the last 6 px.
    const double circle = 2.0 / (kPi * kPi * (1.0 - obscuration) * (kReach - 3.0) / 1.5);
    EXPECT_NEAR(1.0 - inside, circle, 0.05 * circle);
  }
}

TEST(ProfilePsf, IsContinuousWhereverTheStarGoes) {
  constexpr double kAccuracy = 1e-6;
  const auto psf = make_airy_psf(1.6, 0.3, {}, kAccuracy);
  for (const double edge : {0.0, 1.0}) {  // where a star's own pixel, and with it core and wings, jump
    const auto below = render(*psf, {edge - 1e-10, 0.3}, {-20, -20, 41, 41});
    const auto above = render(*psf, {edge + 1e-10, 0.3}, {-20, -20, 41, 41});
    for (std::size_t i = 0; i < below.size(); ++i) EXPECT_NEAR(below[i], above[i], 0.5 * kAccuracy);
    EXPECT_NEAR(sum_of(below), sum_of(above), 20.0 * kAccuracy);
  }
}

TEST(ProfilePsf, HasTheGradientOfItsFractions) {
  const auto psf = make_moffat_psf(1.5, 3.0, {}, 1e-7);
  constexpr Rectangle kBox{-9, -4, 20, 9};
  std::vector<double> dpdx(kBox.size());
  std::vector<double> dpdy(kBox.size());
  psf->integrate_gradient({0.31, 0.12}, kBox, dpdx, dpdy);
  constexpr double kStep = 1e-4;
  const auto right = render(*psf, {0.31 + kStep, 0.12}, kBox);
  const auto left = render(*psf, {0.31 - kStep, 0.12}, kBox);
  const auto upper = render(*psf, {0.31, 0.12 + kStep}, kBox);
  const auto lower = render(*psf, {0.31, 0.12 - kStep}, kBox);
  for (std::size_t i = 0; i < dpdx.size(); ++i) {
    EXPECT_NEAR(dpdx[i], (right[i] - left[i]) / (2.0 * kStep), 1e-6);
    EXPECT_NEAR(dpdy[i], (upper[i] - lower[i]) / (2.0 * kStep), 1e-6);
  }
}

TEST(ProfilePsf, AddsTheFractionsOfIntegrateWhateverTheBox) {
  const auto psf = make_moffat_psf(1.3, 2.5, {.reach = 20}, 1e-6);
  std::vector<double> scratch;
  const MotionCovariance motion{0.02, 0.004, 0.01};
  for (const bool broadened : {false, true}) {
    Image<double, unit::ExpectedElectrons> image(60, 50);
    const StarLight star{{23.37, 21.71}, 1e6, 18.0, motion, broadened};
    psf->add_star(star, image.view(), scratch);
    std::vector<double> fractions(image.size());
    if (broadened) {
      psf->integrate_broadened(star.centre, motion, image.area(), fractions, scratch);
    } else {
      psf->integrate(star.centre, image.area(), fractions);
    }
    const Rectangle stamp = stamp_box(star.centre, star.half_width);
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 60; ++x) {
        const double expected = stamp.contains(x, y) ? 1e6 * fractions[static_cast<std::size_t>(y * 60 + x)] : 0.0;
        EXPECT_NEAR(image.at(x, y), expected, 1e-7) << x << " " << y;
      }
    // A window of the same image has the same bits.
    Image<double, unit::ExpectedElectrons> window(Rectangle{17, 19, 11, 7});
    psf->add_star(star, window.view(), scratch);
    for (int y = 19; y < 26; ++y)
      for (int x = 17; x < 28; ++x) EXPECT_EQ(window.at(x, y), image.at(x, y));
  }
}

TEST(ProfilePsf, NamesAStampOutsideOfWhichLittleFalls) {
  const auto psf = make_moffat_psf(1.4, 3.0, {.reach = 40}, 1e-6);
  const double all = sum_of(render(*psf, {0.0, 0.0}, {-45, -45, 91, 91}));
  for (const double lost : {1e-2, 1e-3, 1e-4}) {
    const double r = psf->stamp_half_width(lost);
    for (const PixelPosition star : {PixelPosition{0.0, 0.0}, {0.5, 0.49}}) {
      const double inside = sum_of(render(*psf, star, stamp_box(star, r)));
      EXPECT_LT(all - inside, lost);
      EXPECT_GT(all - inside, 0.3 * lost);  // and is not much larger than it need be
    }
  }
  EXPECT_LE(psf->stamp_half_width(1e-13), 40.0);
  EXPECT_GT(psf->stamp_half_width(1e-13), 38.0);
}

TEST(ProfilePsf, RefusesWhatCannotBe) {
  EXPECT_THROW(static_cast<void>(make_moffat_psf(0.0, 3.0, {}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(make_moffat_psf(1.0, 1.0, {}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(make_moffat_psf(1.0, 3.0, {.reach = 1}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(make_moffat_psf(1.0, 3.0, {.diffusion = -0.1}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(make_airy_psf(std::nan(""), 0.0, {}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(make_airy_psf(1.0, 1.0, {}, 1e-6)), InputError);
}

TEST(Diffusion, AddsItsVariance) {
  // A Gaussian stays one.
  for (const double diffusion : {0.05, 0.2, 0.5}) {
    const auto diffused =
        make_prf_psf(diffuse_psf_table(test::gaussian_psf_table(0.6, 16.0, 6.0), Pixels(diffusion)), 1e-8);
    const auto exact = make_gaussian_psf(std::hypot(0.6, diffusion));
    for (const PixelPosition star : {PixelPosition{0.0, 0.0}, {0.3, -0.45}}) {
      const double flux = sum_of(render(*exact, star, {-1, -1, 3, 3}));
      EXPECT_NEAR(sum_of(render(*diffused, star, {-1, -1, 3, 3})) / flux, 1.0, 3e-6) << diffusion;
    }
    EXPECT_NEAR(sum_of(render(*diffused, {0.1, 0.2}, {-20, -20, 41, 41})), 1.0, 1e-13);
  }
}

TEST(Diffusion, OfACoarseTableStillAddsItsVariance) {
  // Two samples a pixel, and kernels down to a twentieth of a sample: second moments of table and result, by Sheppard.
  const auto variance = [](const PsfTable& table) {
    double sum = 0.0;
    double moment = 0.0;
    for (int y = 0; y < table.samples.ny(); ++y)
      for (int x = 0; x < table.samples.nx(); ++x) {
        const double d = (x - table.centre_x) / table.samples_per_pixel;
        sum += table.samples.at(x, y);
        moment += table.samples.at(x, y) * (d * d - 1.0 / (12.0 * table.samples_per_pixel * table.samples_per_pixel));
      }
    return moment / sum;
  };
  const PsfTable table = test::gaussian_psf_table(0.8, 2.0, 8.0);
  const double before = variance(diffuse_psf_table(table, Pixels(0.0)));
  for (const double diffusion : {0.02, 0.1, 0.3, 0.7}) {
    const double after = variance(diffuse_psf_table(table, Pixels(diffusion)));
    EXPECT_NEAR(after - before, diffusion * diffusion, 0.02 * diffusion * diffusion + 2e-4) << diffusion;
  }
  EXPECT_THROW(static_cast<void>(diffuse_psf_table(table, Pixels(-0.1))), InputError);
}

TEST(Diffusion, OfAProfileIsTheMeanOverDiffusedPlaces) {
  constexpr double kSigma = 0.25;
  for (const double narrow : {kSigma, 0.02}) {
    const auto sharp = make_airy_psf(1.5, 0.3, {.reach = 8}, 1e-7);
    const auto diffused = make_airy_psf(1.5, 0.3, {.reach = 8, .diffusion = narrow}, 1e-7);
    constexpr PixelPosition kStar{0.2, -0.35};
    // The trapezium rule over a Gaussian converges beyond all orders.
    double mean = 0.0;
    double weights = 0.0;
    for (int j = -24; j <= 24; ++j)
      for (int i = -24; i <= 24; ++i) {
        const double weight = std::exp(-0.5 * (i * i + j * j) / 16.0);
        const PixelPosition moved{kStar.x + 0.25 * i * narrow, kStar.y + 0.25 * j * narrow};
        mean += weight * sum_of(render(*sharp, moved, {-1, -1, 3, 3}));
        weights += weight;
      }
    EXPECT_NEAR(sum_of(render(*diffused, kStar, {-1, -1, 3, 3})) / (mean / weights), 1.0, 5e-7);
  }
}

}  // namespace
}  // namespace astroid
