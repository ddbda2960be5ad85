// The optimal mask end to end: masks, noise-to-signal ratios and contamination of Gaussian stars known from elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

// A PLATO camera (SCIENCE §3.2): zero point 20.62, 21 s, sky 945 e-/px, readout 50.2 e-, quantisation 7.2 e-.
double plato_electrons(double magnitude) {
  return 21.0 * det::exp10(-0.4 * (magnitude - 20.62));
}

test::GroundScene plato_scene(double sigma) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(sigma);
  scene.noise = {945.0, 50.2, 7.2};
  return scene;
}

PhotometrySettings known_background_mask() {
  PhotometrySettings settings;
  settings.method = PhotometryMethod::kMask;
  settings.background = BackgroundMethod::kKnown;
  return settings;
}

// 24 cameras, 144 exposures an hour.
double nsr_1h_ppm(double nsr_exposure) {
  return 1e6 * nsr_exposure / (12.0 * std::sqrt(24.0));
}

TEST(OptimalMask, GivesTheNoiseOfAPlatoStar) {
  struct Row {
    double magnitude, electrons, nsr, hour;
  };
  for (const Row& row : {Row{10.0, 371722.881, 1.731782e-3, 29.4582}, Row{11.0, 147985.544, 2.906516e-3, 49.4408},
                         Row{12.0, 58914.106, 5.195210e-3, 88.3723}}) {
    test::GroundScene scene = plato_scene(0.6);
    scene.add_target({12.0, 12.0}, plato_electrons(row.magnitude));
    EXPECT_NEAR(scene.stars[0].electrons / row.electrons, 1.0, 1e-8);
    const StarEstimator star = build_estimators(*test::full_frame(25, 25), scene.model(), known_background_mask())[0];
    EXPECT_EQ(star.mask_pixels, 9);
    EXPECT_NEAR(star.enclosed_fraction, 0.975316, 1e-6);
    EXPECT_NEAR(star.nsr_exposure / row.nsr, 1.0, 1e-6);
    EXPECT_NEAR(nsr_1h_ppm(star.nsr_exposure) / row.hour, 1.0, 2e-6);
    EXPECT_EQ(star.window, (Rectangle{10, 10, 6, 6}));
    EXPECT_EQ(star.flags, 0U);
    EXPECT_EQ(star.spr_total, 0.0);
    EXPECT_DOUBLE_EQ(star.offset, 9 * 945.0);
  }
}

TEST(OptimalMask, HasAsManyPixelsAsPublishedForAPlatoStar) {
  // P = 11.12: a published star of that magnitude has 8 pixels and 55-60 ppm√h in 24 cameras.
  test::GroundScene scene = plato_scene(0.8);
  scene.add_target({12.0, 12.0}, plato_electrons(11.12));
  const StarEstimator star = build_estimators(*test::full_frame(25, 25), scene.model(), known_background_mask())[0];
  EXPECT_GE(star.mask_pixels, 7);
  EXPECT_LE(star.mask_pixels, 12);
  EXPECT_GT(nsr_1h_ppm(star.nsr_exposure), 50.0);
  EXPECT_LT(nsr_1h_ppm(star.nsr_exposure), 60.0);
}

TEST(OptimalMask, IsASymmetricSetForASymmetricStar) {
  for (const double magnitude : {8.0, 10.0, 12.0, 14.0, 16.0}) {
    test::GroundScene scene = plato_scene(0.6);
    scene.add_target({12.0, 12.0}, plato_electrons(magnitude));
    const auto layout = test::full_frame(25, 25);
    const StarEstimator star = build_estimators(*layout, scene.model(), known_background_mask())[0];
    double moment_x = 0.0;
    double moment_y = 0.0;
    for (const EstimatorTerm& term : star.terms) {
      const std::uint32_t row = term.pixel / 25U;
      moment_x += static_cast<double>(term.pixel - 25U * row) - 12.0;
      moment_y += static_cast<double>(row) - 12.0;
    }
    EXPECT_EQ(moment_x, 0.0) << magnitude;
    EXPECT_EQ(moment_y, 0.0) << magnitude;
  }
}

TEST(OptimalMask, KnowsTheContaminationOfANeighbour) {
  struct Row {
    double dx, delta_mag;
    int pixels;
    double spr, hour;
  };
  for (const Row& row : {Row{1.0, 0.0, 7, 0.38153972, 62.6266}, Row{2.0, 2.0, 9, 0.03144899, 50.0948}}) {
    test::GroundScene scene = plato_scene(0.6);
    scene.add_target({12.0, 12.0}, plato_electrons(11.0));
    scene.add_star({12.0 + row.dx, 12.0}, plato_electrons(11.0 + row.delta_mag));
    const StarEstimator star = build_estimators(*test::full_frame(25, 25), scene.model(), known_background_mask())[0];
    EXPECT_EQ(star.mask_pixels, row.pixels);
    EXPECT_NEAR(star.spr_total / row.spr, 1.0, 1e-6);
    EXPECT_NEAR(nsr_1h_ppm(star.nsr_exposure) / row.hour, 1.0, 2e-6);
    EXPECT_EQ(star.flags, measurement_flag::kContaminated);
  }
}

TEST(FixedMask, IsContaminatedLessByFartherAndFainterNeighbours) {
  // An optimal mask gives way to its neighbours; one that stays the same shows the neighbour alone.
  PhotometrySettings settings = known_background_mask();
  settings.method = PhotometryMethod::kAperture;
  settings.aperture_radius = Pixels(1.5);
  double last = 1.0;
  for (const double dx : {0.5, 1.5, 2.5, 3.5}) {
    test::GroundScene scene = plato_scene(0.6);
    scene.add_target({12.0, 12.0}, plato_electrons(11.0));
    scene.add_star({12.0 + dx, 12.2}, plato_electrons(12.0));
    const double spr = build_estimators(*test::full_frame(25, 25), scene.model(), settings)[0].spr_total;
    EXPECT_LT(spr, last);
    EXPECT_GT(spr, 0.0);
    last = spr;
  }
  last = 1.0;
  for (const double magnitude : {9.0, 11.0, 13.0, 20.0}) {
    test::GroundScene scene = plato_scene(0.6);
    scene.add_target({12.0, 12.0}, plato_electrons(11.0));
    scene.add_star({13.5, 12.2}, plato_electrons(magnitude));
    const double spr = build_estimators(*test::full_frame(25, 25), scene.model(), settings)[0].spr_total;
    EXPECT_LT(spr, last);
    EXPECT_GT(spr, 0.0);
    last = spr;
  }
}

TEST(WeightedMask, IsNeverNoisierThanTheBinaryOneAndGivesAllTheFlux) {
  for (const double magnitude : {9.0, 11.0, 13.0, 15.0}) {
    test::GroundScene scene = plato_scene(0.6);
    scene.add_target({12.3, 11.8}, plato_electrons(magnitude));
    PhotometrySettings settings = known_background_mask();
    const double binary = build_estimators(*test::full_frame(25, 25), scene.model(), settings)[0].nsr_exposure;
    settings.method = PhotometryMethod::kWeighted;
    const StarEstimator star = build_estimators(*test::full_frame(25, 25), scene.model(), settings)[0];
    EXPECT_LT(star.nsr_exposure, binary);
    EXPECT_NEAR(star.enclosed_fraction, 1.0, 1e-6);
    EXPECT_NEAR(star.budget.target / scene.stars[0].electrons, 1.0, 1e-6);
  }
}

TEST(LocalBackground, AddsItsOwnNoise) {
  // SCIENCE §3.2: an annulus of 100 px adds 1.6 % to the noise at P = 12; variance in proportion to n²/n_B.
  test::GroundScene scene = plato_scene(0.6);
  scene.add_target({20.0, 20.0}, plato_electrons(12.0));
  PhotometrySettings settings = known_background_mask();
  const StarEstimator known = build_estimators(*test::full_frame(41, 41), scene.model(), settings)[0];
  settings.background = BackgroundMethod::kLocal;
  const StarEstimator local = build_estimators(*test::full_frame(41, 41), scene.model(), settings)[0];
  const auto background_pixels = static_cast<double>(local.terms.size() - local.aperture_terms);
  EXPECT_GT(background_pixels, 100.0);
  EXPECT_NEAR(local.budget.var_background_estimate, 81.0 / background_pixels * scene.noise.variance(), 1.0);
  const double added = local.nsr_exposure / known.nsr_exposure - 1.0;
  EXPECT_NEAR(added * background_pixels / 100.0, 0.016, 1e-3);
  EXPECT_NEAR(local.offset, 0.0, 1e-3);
  EXPECT_EQ(local.flags, 0U);
}

}  // namespace
}  // namespace astroid
