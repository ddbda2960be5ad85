// How much light of a Gaussian star falls into an aperture, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

PhotometrySettings aperture(double radius) {
  PhotometrySettings settings;
  settings.method = PhotometryMethod::kAperture;
  settings.background = BackgroundMethod::kKnown;
  settings.aperture_radius = Pixels(radius);
  return settings;
}

// An aperture spreads the light of a rim pixel evenly over it: the star's position within its pixel (1/12 px² per axis)
// is replaced by an independent one (1/12 px² more). A star narrower by that much looks like one of `sigma` to an
// aperture.
double narrowed(double sigma) {
  return std::sqrt(sigma * sigma - 1.0 / 6.0);
}

StarEstimator measure_alone(double sigma, double radius, const PixelNoise& noise, PixelPosition centre, int side) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(narrowed(sigma));
  scene.noise = noise;
  scene.add_target(centre, 1e4);
  return build_estimators(*test::full_frame(side, side), scene.model(), aperture(radius))[0];
}

TEST(AperturePhotometry, EnclosesTheEnergyOfAGaussian) {
  constexpr double kSigma = 25.0;
  struct Row {
    double radius_in_sigma, fraction;
  };
  for (const Row& row : {Row{1.0, 0.39346934}, Row{2.0, 0.86466472}, Row{3.0, 0.98889100}}) {
    for (const PixelPosition centre : {PixelPosition{120.0, 120.0}, {120.5, 120.5}, {120.31, 119.87}}) {
      const StarEstimator star = measure_alone(kSigma, row.radius_in_sigma * kSigma, {}, centre, 241);
      EXPECT_NEAR(star.enclosed_fraction, row.fraction, 1e-5) << row.radius_in_sigma;
      EXPECT_EQ(star.flags, 0U);
    }
  }
}

TEST(AperturePhotometry, IsBestAtTheKnownRadiusWhenTheSkyDominates) {
  // F6: r = 1.5852 sigma encloses 0.71533 and reaches 0.90251 of the signal-to-noise of a PSF fit, F/√(4π sigma² B).
  constexpr double kSigma = 20.0;
  constexpr double kSky = 1e6;
  const PixelNoise sky{kSky, 0.0, 0.0};
  const PixelPosition centre{80.0, 80.0};
  const StarEstimator best = measure_alone(kSigma, 1.5852010 * kSigma, sky, centre, 161);
  EXPECT_LT(best.nsr_exposure, measure_alone(kSigma, 1.50 * kSigma, sky, centre, 161).nsr_exposure);
  EXPECT_LT(best.nsr_exposure, measure_alone(kSigma, 1.67 * kSigma, sky, centre, 161).nsr_exposure);
  EXPECT_NEAR(best.enclosed_fraction, 0.7153319, 2e-5);
  const double fit_snr = 1e4 / std::sqrt(4.0 * kPi * kSigma * kSigma * kSky);
  // Pixels on the rim enter with weights below one, which averages a little of their noise away.
  double sum = 0.0;
  double squares = 0.0;
  for (const EstimatorTerm& term : best.terms) {
    sum += static_cast<double>(term.weight);
    squares += static_cast<double>(term.weight) * static_cast<double>(term.weight);
  }
  EXPECT_NEAR(1.0 / best.nsr_exposure / fit_snr * std::sqrt(squares / sum), 0.9025125, 1e-4);
}

TEST(AperturePhotometry, KnowsTheLightOfANeighbourBesideTheAperture) {
  // F23 in units of 40 px: R = 1.5, sigma = 0.6; contamination of an equally bright star at distance d.
  constexpr double kScale = 40.0;
  constexpr double kOwn = 0.95606306638;
  struct Row {
    double distance, fraction;
  };
  for (const Row& row :
       {Row{0.5, 0.90420167053}, Row{1.0, 0.71878264697}, Row{2.0, 0.15630156392}, Row{3.0, 4.1367491686e-3}}) {
    test::GroundScene scene;
    scene.psf = make_gaussian_psf(narrowed(0.6 * kScale));
    scene.noise = {100.0, 0.0, 0.0};
    scene.add_target({100.0, 100.0}, 1e5);
    scene.add_star({100.0, 100.0 + row.distance * kScale}, 1e5);
    const StarEstimator star = build_estimators(*test::full_frame(201, 201), scene.model(), aperture(1.5 * kScale))[0];
    const double expected = row.fraction / (row.fraction + kOwn);
    EXPECT_NEAR(star.spr_total / expected, 1.0, 3e-4) << row.distance;
    EXPECT_NEAR(star.budget.contaminants / 1e5, row.fraction, 1e-5) << row.distance;
  }
}

TEST(AperturePhotometry, HasTheVarianceOfTheCcdEquation) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({20.0, 20.0}, 1e5);
  scene.add_star({23.0, 21.0}, 4e4);
  const StarEstimator star = build_estimators(*test::full_frame(41, 41), scene.model(), aperture(3.0))[0];
  double squares = 0.0;
  for (const EstimatorTerm& term : star.terms)
    squares += static_cast<double>(term.weight) * static_cast<double>(term.weight);
  const EstimatorBudget& budget = star.budget;
  EXPECT_NEAR(budget.var_background + budget.var_readout + budget.var_quantisation, squares * scene.noise.variance(),
              1e-6);
  EXPECT_NEAR(budget.var_target / budget.target, 1.0, 2e-3) << "only rim pixels have weights below one";
  EXPECT_DOUBLE_EQ(star.nsr_exposure, std::sqrt(budget.variance()) / budget.target);
  EXPECT_EQ(budget.var_background_estimate, 0.0);
}

}  // namespace
}  // namespace astroid
