// How other tools put stars on pixels: their errors are those that were published or derived, so that a comparison with
// them is fair.
#include "astroid/core/textbook_psf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "astroid/core/error.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"

namespace astroid {
namespace {

constexpr int kPhases = 200;

struct Errors {
  double rms = 0.0, most = 0.0;  // ppm
};

// Light in 3 × 3 px of stars anywhere in the middle pixel, against the exact one.
Errors errors(const PixelPsf& psf, const PixelPsf& exact) {
  constexpr Rectangle kMask{-1, -1, 3, 3};
  const auto light = [&](const PixelPsf& p, PixelPosition star) {
    std::array<double, 9> fractions{};
    p.integrate(star, kMask, fractions);
    double sum = 0.0;
    for (const double f : fractions) sum += f;
    return sum;
  };
  Errors e;
  for (int k = 0; k < kPhases; ++k) {
    // Evenly spread, but on no grid.
    const PixelPosition star{std::fmod(0.7548776662466927 * (k + 1), 1.0) - 0.5,
                             std::fmod(0.5698402909980532 * (k + 1), 1.0) - 0.5};
    const double error = 1e6 * (light(psf, star) / light(exact, star) - 1.0);
    e.rms += error * error / kPhases;
    e.most = std::max(e.most, std::abs(error));
  }
  e.rms = std::sqrt(e.rms);
  return e;
}

struct Published {
  TextbookMethod method;
  int n;
  double sigma;
  double rms;  // ppm
};

// Gaussians, 3 × 3 px: computed independently when the project began, with other places in the pixel.
TEST(TextbookMethods, HaveTheErrorsOfThePublishedTable) {
  using M = TextbookMethod;
  for (const Published& p : {Published{M::kSnap, 8, 0.6, 4509.0},
                             {M::kSnap, 64, 0.6, 565.0},
                             Published{M::kSnap, 16, 1.0, 3320.0},
                             {M::kMidpoint, 8, 0.6, 441.0},
                             Published{M::kMidpoint, 16, 0.5, 75.0},
                             {M::kMidpoint, 4, 1.0, 2310.0},
                             Published{M::kGaussLegendre, 2, 0.6, 1030.0},
                             {M::kGaussLegendre, 3, 0.6, 46.9},
                             Published{M::kGaussLegendre, 5, 0.6, 0.055},
                             {M::kLinear, 8, 0.6, 919.0},
                             Published{M::kLinear, 16, 1.0, 311.0},
                             {M::kCubic, 8, 0.6, 12.2},
                             Published{M::kCubic, 16, 0.6, 0.76},
                             {M::kCubic, 32, 0.5, 0.081}}) {
    const auto exact = make_gaussian_psf(p.sigma);
    const auto psf =
        make_textbook_psf(p.method, p.n, {.exact = exact, .brightness = gaussian_brightness(p.sigma), .reach = 6});
    const Errors e = errors(*psf, *exact);
    std::printf("%-24s sigma %.1f: rms %.4g ppm (published %.4g), at most %.4g\n", psf->description().c_str(), p.sigma,
                e.rms, p.rms, e.most);
    EXPECT_NEAR(e.rms / p.rms, 1.0, 0.2);
    EXPECT_LT(e.most, 6.0 * e.rms);
  }
}

TEST(TextbookMethods, OfATableConvergeToItsExactIntegral) {
  const PsfTable table = test::gaussian_psf_table(0.7, 8, 5.0);
  const auto exact = make_exact_table_psf(table);
  const TextbookSource source{.exact = exact, .brightness = table_brightness(table), .reach = 7};
  const auto rms = [&](TextbookMethod method, int n) {
    return errors(*make_textbook_psf(method, n, source), *exact).rms;
  };
  EXPECT_NEAR(rms(TextbookMethod::kSnap, 16) / rms(TextbookMethod::kSnap, 32), 2.0, 0.3);
  EXPECT_NEAR(rms(TextbookMethod::kLinear, 8) / rms(TextbookMethod::kLinear, 16), 4.0, 1.0);
  EXPECT_GT(rms(TextbookMethod::kCubic, 4) / rms(TextbookMethod::kCubic, 8), 8.0);
  EXPECT_LT(rms(TextbookMethod::kMidpoint, 64), 15.0);
  EXPECT_LT(errors(*make_prf_psf(table, 1e-6), *exact).most, 1.0);
}

TEST(ExactTable, IsTheOraclesIntegral) {
  const PsfTable table = test::gaussian_psf_table(0.5, 6, 4.0);
  const auto exact = make_exact_table_psf(table);
  const test::SurfaceBrightness oracle = test::table_brightness(table);
  const SurfaceBrightness brightness = table_brightness(table);
  const PixelPosition star{0.21, -0.37};
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) {
      std::array<double, 1> fraction{};
      exact->integrate(star, {x, y, 1, 1}, fraction);
      const auto truth =
          static_cast<double>(test::integrate_area(oracle, star, test::area_of({x, y, 1, 1}), 1e-15L).value);
      EXPECT_NEAR(fraction[0], truth, 1e-13);
      EXPECT_NEAR(brightness(x - star.x, y - star.y),
                  static_cast<double>(
                      oracle.density(x - static_cast<long double>(star.x), y - static_cast<long double>(star.y))),
                  1e-11);
    }
  EXPECT_EQ(brightness(50.0, 0.0), 0.0);
}

TEST(TextbookMethods, RefuseNumbersThatMakeNoSense) {
  const TextbookSource source{.exact = make_gaussian_psf(1.0), .brightness = gaussian_brightness(1.0)};
  EXPECT_THROW((void)make_textbook_psf(TextbookMethod::kSnap, 0, source), InputError);
  EXPECT_THROW((void)make_textbook_psf(TextbookMethod::kGaussLegendre, 11, source), InputError);
}

}  // namespace
}  // namespace astroid
