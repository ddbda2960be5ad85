// What an estimator says of the effect of motion and of a flat field, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

StarEstimator build(double sigma, PixelPosition centre, PhotometryMethod method, double radius) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(sigma);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target(centre, 148000.0);
  PhotometrySettings settings;
  settings.method = method;
  settings.background = BackgroundMethod::kKnown;
  settings.aperture_radius = Pixels(radius);
  return build_estimators(*test::full_frame(41, 41), scene.model(), settings)[0];
}

TEST(EstimatorGradient, IsThatOfASquareApertureOnAGaussian) {
  // F25: half-width 1.5 px, sigma 0.6 px.
  struct Row {
    double offset, gradient;
  };
  for (const Row& row : {Row{0.1, -0.0250517}, Row{0.25, -0.0678376}}) {
    const StarEstimator star = build(0.6, {20.0 + row.offset, 20.0}, PhotometryMethod::kMask, 0.0);
    ASSERT_EQ(star.mask_pixels, 9) << "the mask is 3 × 3 px";
    EXPECT_NEAR(star.gradient_x, row.gradient, 1e-6);
    EXPECT_NEAR(star.gradient_y, 0.0, 1e-12);
  }
}

TEST(EstimatorGradient, CountsNeighboursThatMoveAlong) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({20.1, 20.2}, 1e5);
  scene.add_star({22.0, 19.0}, 5e4);
  PhotometrySettings settings;
  settings.background = BackgroundMethod::kKnown;
  const auto layout = test::full_frame(41, 41);
  const StarEstimator star = build_estimators(*layout, scene.model(), settings)[0];
  const auto flux_at = [&](double dx, double dy) {
    test::GroundScene moved = scene;
    for (FieldStar& s : moved.stars) s.position = {s.position.x + dx, s.position.y + dy};
    moved.noise.background = 0.0;
    const std::vector<double> light = test::expected_electrons(*layout, moved);
    double flux = 0.0;
    for (const EstimatorTerm& term : star.terms) flux += static_cast<double>(term.weight) * light[term.pixel];
    return flux;
  };
  constexpr double kStep = 1e-2;
  EXPECT_NEAR(star.gradient_x, (flux_at(kStep, 0) - flux_at(-kStep, 0)) / (2 * kStep * flux_at(0, 0)), 1e-4);
  EXPECT_NEAR(star.gradient_y, (flux_at(0, kStep) - flux_at(0, -kStep)) / (2 * kStep * flux_at(0, 0)), 1e-4);
  EXPECT_GT(std::abs(star.gradient_x), 1e-3);
}

TEST(EstimatorPrnu, FollowsFromThePixelIntegratedPsf) {
  // F27: sqrt(sum (dp/dx)²); F28: sqrt(sum p²) = 1/sqrt(noise-equivalent area), F40. The aperture holds all the light.
  struct Row {
    double sigma, gradient_centre, gradient_edge, area_centre, area_corner;
  };
  for (const Row& row :
       {Row{0.5, 0.4825, 0.7090, 3.762219, 4.797232}, Row{0.6, 0.4102, 0.4878, 5.372401, 5.849305},
        Row{0.8, 0.2725, 0.2776, 9.083455, 9.134187}, Row{1.0, 0.18380, 0.18395, 13.624990, 13.627202}}) {
    const StarEstimator centre = build(row.sigma, {20.0, 20.0}, PhotometryMethod::kAperture, 9.0);
    EXPECT_NEAR(centre.prnu_gradient_x, row.gradient_centre, 6e-5);
    EXPECT_NEAR(centre.prnu_gradient_y, row.gradient_centre, 6e-5);
    EXPECT_NEAR(centre.prnu_static, 1.0 / std::sqrt(row.area_centre), 1e-7);
    EXPECT_NEAR(build(row.sigma, {20.5, 20.0}, PhotometryMethod::kAperture, 9.0).prnu_gradient_x, row.gradient_edge,
                6e-5);
    EXPECT_NEAR(build(row.sigma, {20.5, 20.5}, PhotometryMethod::kAperture, 9.0).prnu_static,
                1.0 / std::sqrt(row.area_corner), 1e-7);
  }
}

}  // namespace
}  // namespace astroid
