#include "astroid/core/gaussian_aperture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/core/jitter_noise.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/units.hpp"
#include "astroid/test/quadrature.hpp"

namespace astroid {
namespace {

TEST(GaussianInCircle, ReproducesReferenceValues) {
  EXPECT_NEAR(gaussian_in_circle(0.6, 1.5, 0.0), 0.95606306638, 5e-12);
  EXPECT_NEAR(gaussian_in_circle(0.6, 1.5, 0.5), 0.90420167053, 5e-12);
  EXPECT_NEAR(gaussian_in_circle(0.6, 1.5, 1.0), 0.71878264697, 5e-12);
  EXPECT_NEAR(gaussian_in_circle(0.6, 1.5, 2.0), 0.15630156392, 5e-12);
  EXPECT_NEAR(gaussian_in_circle(0.6, 1.5, 3.0) / 4.1367491686e-3, 1.0, 2e-11);
  EXPECT_NEAR(gaussian_in_circle(0.6, 1.5, 5.0) / 1.4473605846e-9, 1.0, 5e-11);
}

TEST(GaussianInCircle, AgreesWithPolarQuadrature) {
  // Along the radius r' from the aperture's centre: the density averaged over the angle, by quadrature over the angle.
  for (const double sigma : {0.3, 0.6, 2.0}) {
    for (const double distance : {0.0, 0.7, 3.0, 6.0}) {
      const double radius = 1.5;
      const auto density = test::gaussian_density(sigma);
      const long double pi = 3.14159265358979323846264338327950288L;
      const long double exact = test::integrate(
          [&](long double r) {
            return 2.0L * r *
                   test::integrate(
                       [&](long double phi) {
                         return density(r * std::cos(phi) - static_cast<long double>(distance), r * std::sin(phi));
                       },
                       0.0L, pi, 1e-15L);
          },
          0.0L, static_cast<long double>(radius), 1e-15L);
      EXPECT_NEAR(gaussian_in_circle(sigma, radius, distance) / static_cast<double>(exact), 1.0, 1e-12)
          << sigma << " " << distance;
    }
  }
}

TEST(GaussianInCircle, KnowsItsLimits) {
  EXPECT_EQ(gaussian_in_circle(1.0, 0.0, 0.5), 0.0);
  EXPECT_NEAR(gaussian_in_circle(1.0, 100.0, 3.0), 1.0, 1e-12);
  EXPECT_NEAR(gaussian_in_circle(1.0, 60.0, 55.0), 0.9999997, 1e-7);  // edge 5 sigma away
  EXPECT_NEAR(gaussian_in_circle(1.0, 1000.0, 1000.0), 0.5, 1e-3);    // an edge that is almost straight
  for (const double r : {1.0, 2.0, 3.0}) EXPECT_NEAR(gaussian_in_circle(1.0, r, 0.0), -std::expm1(-0.5 * r * r), 1e-15);
}

TEST(GaussianInInterval, SquaredIsTheFluxInASquare) {
  const double expected[] = {0.46606494, 0.91106975, 0.99460770};
  for (int r = 1; r <= 3; ++r) {
    const double axis = gaussian_in_interval(1.0, r, 0.0);
    EXPECT_NEAR(axis * axis, expected[r - 1], 5e-9);
  }
}

TEST(OptimalCircularAperture, ReproducesReferenceValues) {
  const auto best = optimal_circular_aperture();
  EXPECT_NEAR(best.radius_sigma, 1.5852010, 1e-7);  // the reference is cut, not rounded: 1.58520107
  EXPECT_NEAR(best.radius_fwhm, 0.6731729, 5e-8);
  EXPECT_NEAR(best.enclosed, 0.7153319, 5e-8);
  EXPECT_NEAR(best.snr_ratio, 0.9025125, 5e-8);
}

constexpr double kSigma = 0.6;            // px
constexpr double kHalfWidth = 1.5;        // px, three pixels
constexpr double kJitter = 0.038 / 15.0;  // px, PLATO's requirement

TEST(JitterNoise, OfASquareApertureReproducesReferenceValues) {
  EXPECT_NEAR(gaussian_interval_gradient(kSigma, kHalfWidth, 0.1), -0.0250517, 5e-8);
  EXPECT_NEAR(gaussian_interval_gradient(kSigma, kHalfWidth, 0.25), -0.0678376, 5e-8);
  EXPECT_NEAR(gaussian_interval_gradient(kSigma, kHalfWidth, 0.5), -0.1714941, 5e-8);
  const double offsets[] = {0.1, 0.25, 0.5};
  const double ppm[] = {63.46, 171.85, 434.45};
  for (int i = 0; i < 3; ++i) {
    const double g = gaussian_interval_gradient(kSigma, kHalfWidth, offsets[i]);
    EXPECT_NEAR(1e6 * jitter_noise(g, 0.0, kJitter, kJitter), ppm[i], 6e-3);
  }
}

TEST(JitterNoise, OfAPixelMaskIsThatOfTheSquareItFills) {
  const PixelPosition star{0.25, -0.1};
  const Rectangle box{-1, -1, 3, 3};
  std::vector<double> p(9);
  std::vector<double> dpdx(9);
  std::vector<double> dpdy(9);
  const auto psf = make_gaussian_psf(kSigma);
  psf->integrate(star, box, p);
  psf->integrate_gradient(star, box, dpdx, dpdy);
  const std::vector<double> weights(9, 1.0);
  EXPECT_NEAR(aperture_gradient(weights, p, dpdx), gaussian_interval_gradient(kSigma, kHalfWidth, star.x), 1e-14);
  EXPECT_NEAR(aperture_gradient(weights, p, dpdy), gaussian_interval_gradient(kSigma, kHalfWidth, star.y), 1e-14);
}

TEST(JitterNoise, LowersTheMeanFluxAsConvolutionDoes) {
  const auto loss = [](double s) {
    const double still = gaussian_in_interval(kSigma, kHalfWidth, 0.0);
    const double moving = gaussian_in_interval(jittered_sigma(kSigma, s), kHalfWidth, 0.0);
    return 1e6 * (moving * moving / (still * still) - 1.0);
  };
  EXPECT_NEAR(loss(0.0025333), -1.582028, 1e-6);
  EXPECT_NEAR(loss(0.038 / 15.0), -1.582069, 1e-6);
  EXPECT_NEAR(loss(0.01), -24.65642, 5e-6);
  EXPECT_NEAR(loss(0.05), -619.6460, 5e-5);
  EXPECT_NEAR(loss(0.1), -2518.474, 5e-4);
}

struct Slope {
  double sigma, centre, edge, continuum;
};

TEST(PrnuJitterNoise, ReproducesReferenceValues) {
  const Rectangle box{-12, -12, 25, 25};
  std::vector<double> dpdx(box.size());
  std::vector<double> dpdy(box.size());
  for (const Slope& e : {Slope{0.5, 0.4825, 0.7090, 0.7979}, Slope{0.6, 0.4102, 0.4878, 0.5541},
                         Slope{0.8, 0.2725, 0.2776, 0.3117}, Slope{1.0, 0.18380, 0.18395, 0.19947}}) {
    const auto psf = make_gaussian_psf(e.sigma);
    psf->integrate_gradient({0.0, 0.0}, box, dpdx, dpdy);
    EXPECT_NEAR(prnu_jitter_noise(1.0, dpdx, dpdy, 1.0, 0.0), e.centre, 6e-5);
    psf->integrate_gradient({0.5, 0.0}, box, dpdx, dpdy);
    EXPECT_NEAR(prnu_jitter_noise(1.0, dpdx, dpdy, 1.0, 0.0), e.edge, 6e-5);
    EXPECT_NEAR(1.0 / (std::sqrt(8.0 * kPi) * e.sigma * e.sigma), e.continuum, 6e-5);
  }
  make_gaussian_psf(kSigma)->integrate_gradient({0.0, 0.0}, box, dpdx, dpdy);
  EXPECT_NEAR(1e6 * prnu_jitter_noise(0.01, dpdx, dpdy, kJitter, 0.0), 10.4, 0.05);
  EXPECT_NEAR(1e6 * prnu_jitter_noise(0.01, dpdx, dpdy, kJitter, kJitter), 14.7, 0.05);
}

TEST(PrnuStaticNoise, IsTheGainErrorAveragedOverTheNoiseEquivalentArea) {
  const Rectangle box{-12, -12, 25, 25};
  std::vector<double> p(box.size());
  make_gaussian_psf(1.0)->integrate({0.0, 0.0}, box, p);
  EXPECT_NEAR(prnu_static_noise(0.01, p), 0.01 / std::sqrt(13.624990), 1e-9);
}

constexpr Seconds kTau{250.0};

TEST(OuMeanRms, OfAnHourReproducesReferenceValues) {
  EXPECT_NEAR(ou_mean_rms(1.0, kTau, {Seconds(25.0), Seconds(0.0), 144}), 0.360, 5e-4);
  EXPECT_NEAR(ou_mean_rms(1.0, kTau, {Seconds(25.0), Seconds(21.0), 1}), 0.986, 5e-4);
}

TEST(OuMeanRms, OfGaplessExposuresIsThatOfOneLongExposure) {
  const double pieces = ou_mean_rms(1.0, kTau, {Seconds(25.0), Seconds(25.0), 144});
  const double whole = ou_mean_rms(1.0, kTau, {Seconds(3600.0), Seconds(3600.0), 1});
  EXPECT_NEAR(pieces / whole, 1.0, 1e-13);
  const double a = 3600.0 / 250.0;
  EXPECT_NEAR(whole, std::sqrt(2.0 * (a - 1.0 + std::exp(-a)) / (a * a)), 1e-14);
}

TEST(OuMeanRms, OfFastJitterIsWhiteAndOfSlowJitterDoesNotAverage) {
  EXPECT_NEAR(ou_mean_rms(2.0, Seconds(0.01), {Seconds(25.0), Seconds(0.0), 144}), 2.0 / 12.0, 1e-12);
  // Far faster than an exposure, where e^(T/tau) is beyond any number: pieces without gaps are still the whole.
  for (const double tau : {0.2, 0.24, 0.26, 0.01, 1e-6}) {
    const double parts = ou_mean_rms(1.0, Seconds(tau), {Seconds(25.0), Seconds(25.0), 144});
    EXPECT_NEAR(parts / ou_mean_rms(1.0, Seconds(tau), {Seconds(3600.0), Seconds(3600.0), 1}), 1.0, 1e-12) << tau;
  }
  EXPECT_NEAR(ou_mean_rms(2.0, Seconds(1e9), {Seconds(25.0), Seconds(21.0), 144}), 2.0, 1e-5);
}

TEST(OuMeanRms, IsSmoothWhereTheSeriesTakesOver) {
  const double below = ou_mean_rms(1.0, Seconds(1.0), {Seconds(1.0), Seconds(0.01 - 1e-12), 1});
  const double above = ou_mean_rms(1.0, Seconds(1.0), {Seconds(1.0), Seconds(0.01 + 1e-12), 1});
  EXPECT_NEAR(below, above, 1e-12);
}

}  // namespace
}  // namespace astroid
