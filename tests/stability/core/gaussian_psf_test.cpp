// Hard cases N7, N8, N10 and N29: tails, vanishing widths, truncation, denormals.
#include <gtest/gtest.h>

#include <cfenv>
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

double total(const std::vector<double>& values) {
  return static_cast<double>(std::accumulate(values.begin(), values.end(), 0.0L));
}

long double exact_axis(long double sigma, long double star, int pixel) {
  const long double scale = 1.0L / (std::sqrt(2.0L) * sigma);
  const long double a = (static_cast<long double>(pixel) - 0.5L - star) * scale;
  const long double b = (static_cast<long double>(pixel) + 0.5L - star) * scale;
  if (a > 0.0L) return 0.5L * (std::erfc(a) - std::erfc(b));
  if (b < 0.0L) return 0.5L * (std::erfc(-b) - std::erfc(-a));
  return 0.5L * (std::erf(b) - std::erf(a));
}

TEST(GaussianPsf, KeepsItsRelativeAccuracyFarFromTheStar) {
  for (const double sigma : {0.05, 0.2, 0.3, 0.6, 1.0, 2.5, 10.0, 100.0}) {
    const auto psf = make_gaussian_psf(sigma);
    for (const double star : {0.0, 0.125, -0.3, 0.499999, 0.5}) {
      const auto own = static_cast<double>(exact_axis(sigma, star, 0));
      for (const int pixel : {0, 1, -1, 2, 3, 5, -5, 7, 10, 20, 100}) {
        const auto expected = static_cast<double>(exact_axis(sigma, star, pixel));
        if (expected < 1e-140) continue;  // close to 1e-150 a tail counts as zero
        const double p = render(*psf, {star, star}, {pixel, 0, 1, 1})[0];
        EXPECT_NEAR(p / (own * expected), 1.0, 1e-12) << "sigma " << sigma << " star " << star << " pixel " << pixel;
      }
    }
  }
}

TEST(GaussianPsf, DoesNotCancelInTheWing) {
  // One axis of N7 to 60 digits, by continued fractions of erfc at the double 0.3; the other axis divided out.
  const auto narrow = make_gaussian_psf(0.3);
  const double narrow_own = std::erf(0.5 / (std::sqrt(2.0) * 0.3));
  EXPECT_NEAR(render(*narrow, {0, 0}, {5, 0, 1, 1})[0] / narrow_own / 3.67096619931272018e-51, 1.0, 1e-12);
  const auto unit = make_gaussian_psf(1.0);
  const double unit_own = std::erf(0.5 / std::sqrt(2.0));
  EXPECT_NEAR(render(*unit, {0, 0}, {10, 0, 1, 1})[0] / unit_own / 1.04940831747308266e-21, 1.0, 1e-12);
}

TEST(GaussianPsf, SumsToOneOverALargeGrid) {
  constexpr double kFourUlp = 4.0 * 2.220446049250313e-16;
  for (const double sigma : {0.3, 0.6, 1.0, 3.0}) {
    for (const PixelPosition star : {PixelPosition{0.0, 0.0}, PixelPosition{0.37, -0.21}, PixelPosition{0.5, 0.5}}) {
      const int half = 40;
      const auto p = render(*make_gaussian_psf(sigma), star, {-half, -half, 2 * half + 1, 2 * half + 1});
      EXPECT_NEAR(total(p), 1.0, kFourUlp) << sigma;
    }
  }
}

TEST(GaussianPsf, IsExactlySymmetric) {
  const auto p = render(*make_gaussian_psf(0.8), {0.0, 0.0}, {-6, -6, 13, 13});
  for (std::size_t j = 0; j < 13; ++j) {
    for (std::size_t i = 0; i < 13; ++i) {
      EXPECT_EQ(p[j * 13 + i], p[j * 13 + (12 - i)]);
      EXPECT_EQ(p[j * 13 + i], p[(12 - j) * 13 + i]);
      EXPECT_EQ(p[j * 13 + i], p[i * 13 + j]);
    }
  }
}

TEST(GaussianPsf, OfNoWidthIsAPoint) {
  for (const double sigma : {0.0, 1e-300, 1e-12}) {
    const auto psf = make_gaussian_psf(sigma);
    EXPECT_EQ(render(*psf, {1.2, 1.0}, {0, 0, 3, 3}), (std::vector<double>{0, 0, 0, 0, 1, 0, 0, 0, 0}));
    EXPECT_EQ(render(*psf, {0.5, 0.0}, {0, 0, 2, 1}), (std::vector<double>{0.5, 0.5}));
    EXPECT_EQ(render(*psf, {0.5, 0.5}, {0, 0, 2, 2}), (std::vector<double>{0.25, 0.25, 0.25, 0.25}));
    EXPECT_EQ(stamp_box({0.5, 0.5}, psf->stamp_half_width(1e-6)).size(), 4U);
  }
}

TEST(GaussianPsf, JustWideEnoughToBeAGaussianStillSplitsOnTheEdge) {
  const auto p = render(*make_gaussian_psf(1e-7), {0.5, 0.5}, {0, 0, 2, 2});
  EXPECT_EQ(p, (std::vector<double>{0.25, 0.25, 0.25, 0.25}));
}

TEST(GaussianPsf, LosesOutsideACircleWhatTheoryKnows) {
  // N10: e^(-r^2 / 2 sigma^2). Pixels much smaller than the PSF, those with the centre inside the circle counted:
  // a sum over a staircase, so the relative tolerance is the circle's discretisation.
  const double sigma = 60.0;
  const auto psf = make_gaussian_psf(sigma);
  const int half = 500;
  const Rectangle box{-half, -half, 2 * half + 1, 2 * half + 1};
  const auto p = render(*psf, {0.0, 0.0}, box);
  for (const double r : {1.0, 2.0, 3.0, 4.0}) {
    double outside = 1.0 - total(p);
    std::size_t i = 0;
    for (int y = -half; y <= half; ++y) {
      for (int x = -half; x <= half; ++x, ++i) {
        if (std::hypot(x, y) > r * sigma) outside += p[i];
      }
    }
    EXPECT_NEAR(outside / std::exp(-0.5 * r * r), 1.0, 4e-3) << r;
  }
}

TEST(GaussianPsf, StampLosesWhatItPromisesAndNoMore) {
  for (const double sigma : {0.3, 0.6, 1.0, 2.0}) {
    const auto psf = make_gaussian_psf(sigma);
    for (const double lost : {1e-2, 3.35e-4, 1e-6, 1.52e-8}) {
      const double r = psf->stamp_half_width(lost);
      const double inside = std::erf(r / (std::sqrt(2.0) * sigma));
      EXPECT_NEAR((1.0 - inside * inside) / lost, 1.0, 1e-6);
      for (const PixelPosition star : {PixelPosition{0.0, 0.0}, PixelPosition{0.5, 0.5}, PixelPosition{0.25, -0.4}}) {
        EXPECT_LT(1.0 - total(render(*psf, star, stamp_box(star, r))), lost);
      }
    }
  }
}

TEST(GaussianPsf, RaisesNoUnderflowInAFrameFarLargerThanItself) {
  const auto psf = make_gaussian_psf(0.3);
  const Rectangle box{0, 0, 2000, 50};
  std::vector<double> p(box.size());
  psf->integrate({30.2, 20.7}, box, p);  // builds the table
  std::feclearexcept(FE_ALL_EXCEPT);
  psf->integrate({30.2, 20.7}, box, p);
  EXPECT_EQ(std::fetestexcept(FE_UNDERFLOW), 0);
  for (const double value : p) EXPECT_TRUE(value == 0.0 || value >= 1e-300);
}

}  // namespace
}  // namespace astroid
