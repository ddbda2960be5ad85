// Stars where they shouldn't be, frames too small to measure on, stars without light (SCIENCE N37, N39, N40).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

test::GroundScene scene_with_noise() {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  return scene;
}

PhotometrySettings settings_of(PhotometryMethod method, BackgroundMethod background) {
  PhotometrySettings settings;
  settings.method = method;
  settings.background = background;
  return settings;
}

constexpr PhotometryMethod kMethods[] = {PhotometryMethod::kAperture, PhotometryMethod::kMask,
                                         PhotometryMethod::kWeighted, PhotometryMethod::kPsf};

TEST(Estimators, FlagTheStarCutByTheFrameEdge) {
  for (const PhotometryMethod method : kMethods) {
    test::GroundScene scene = scene_with_noise();
    scene.add_target({0.2, 10.0}, 1e5);
    scene.add_target({10.0, 10.0}, 1e5);
    const auto layout = test::full_frame(21, 21);
    const auto stars = build_estimators(*layout, scene.model(), settings_of(method, BackgroundMethod::kKnown));
    EXPECT_EQ(stars[0].flags, measurement_flag::kEdge);
    EXPECT_EQ(stars[1].flags, 0U);
    if (method == PhotometryMethod::kAperture || method == PhotometryMethod::kMask) {
      EXPECT_LT(stars[0].enclosed_fraction, stars[1].enclosed_fraction);
    }
    EXPECT_GT(stars[0].nsr_exposure, stars[1].nsr_exposure);
    EXPECT_TRUE(std::isfinite(stars[0].nsr_exposure));
  }
}

TEST(Estimators, DoNotFlagAWindowThatHoldsTheWholeMask) {
  test::GroundScene scene = scene_with_noise();
  scene.add_target({10.0, 10.0}, 1e5);
  const PixelLayout window({{9, 9, 3, 3}});
  const StarEstimator star =
      build_estimators(window, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kKnown))[0];
  EXPECT_EQ(star.mask_pixels, 9);
  EXPECT_EQ(star.flags, 0U);
}

TEST(Estimators, UseTheKnownBackgroundWhereTheAnnulusIsNotOnTheFrame) {
  test::GroundScene scene = scene_with_noise();
  scene.add_target({10.0, 10.0}, 1e5);
  const PixelLayout window({mask_window({10.0, 10.0}, 6)});
  const StarEstimator star =
      build_estimators(window, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kLocal))[0];
  EXPECT_EQ(star.flags, measurement_flag::kNoBackground);
  EXPECT_DOUBLE_EQ(star.offset, 945.0 * star.mask_pixels);
  EXPECT_EQ(star.terms.size(), star.aperture_terms);
  EXPECT_EQ(star.budget.var_background_estimate, 0.0);
}

TEST(Estimators, GiveNanOutsideTheFrame) {
  for (const PhotometryMethod method : kMethods) {
    test::GroundScene scene = scene_with_noise();
    for (const PixelPosition position :
         {PixelPosition{-0.51, 5.0}, {5.0, 10.51}, {1e30, 5.0}, {kNan, 5.0}, {5.0, -kInfinity}})
      scene.add_target(position, 1e5);
    scene.add_target({5.0, 5.0}, 1e5);
    const auto layout = test::full_frame(11, 11);
    const auto stars = build_estimators(*layout, scene.model(), settings_of(method, BackgroundMethod::kLocal));
    const EstimatorSet set(stars, scene.gain, scene.bias);
    std::vector<double> flux(set.size());
    std::vector<std::uint32_t> flags(set.size());
    test::GroundScene visible = scene;
    visible.stars = {scene.stars.back()};
    set.apply(test::frame_of(layout, scene, test::expected_electrons(*layout, visible)), flux, flags);
    for (std::size_t i = 0; i + 1 < stars.size(); ++i) {
      EXPECT_EQ(flags[i], measurement_flag::kOutside) << i;
      EXPECT_TRUE(std::isnan(flux[i])) << i;
    }
    EXPECT_TRUE(std::isfinite(flux.back()));
  }
}

TEST(Estimators, GiveNanForAStarWithoutLight) {
  for (const PhotometryMethod method : kMethods) {
    test::GroundScene scene = scene_with_noise();
    for (const double electrons : {0.0, -5.0, kNan, kInfinity}) scene.add_target({5.0, 5.0}, electrons);
    const auto layout = test::full_frame(11, 11);
    for (const StarEstimator& star :
         build_estimators(*layout, scene.model(), settings_of(method, BackgroundMethod::kKnown))) {
      EXPECT_EQ(star.flags, measurement_flag::kNoFlux);
      EXPECT_TRUE(star.terms.empty());
      EXPECT_EQ(star.nsr_exposure, kInfinity);
    }
  }
}

TEST(Estimators, MeasureInTheSmallestFrames) {
  for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 40}, {40, 1}}) {
    for (const PhotometryMethod method : kMethods) {
      test::GroundScene scene = scene_with_noise();
      scene.add_target({0.1, -0.2}, 1e5);
      const auto layout = test::full_frame(nx, ny);
      const auto stars = build_estimators(*layout, scene.model(), settings_of(method, BackgroundMethod::kLocal));
      const EstimatorSet set(stars, scene.gain, scene.bias);
      std::vector<double> flux(1);
      std::vector<std::uint32_t> flags(1);
      set.apply(test::frame_of(layout, scene, test::expected_electrons(*layout, scene)), flux, flags);
      EXPECT_NEAR(flux[0] / (stars[0].budget.target + stars[0].budget.contaminants), 1.0, 1e-5);
      EXPECT_EQ(flags[0], measurement_flag::kEdge | measurement_flag::kNoBackground);
    }
  }
}

TEST(Estimators, CountTheLightOfStarsBeyondTheFrame) {
  test::GroundScene scene = scene_with_noise();
  scene.add_target({1.0, 10.0}, 1e5);
  scene.add_star({-1.5, 10.0}, 1e5);
  const StarEstimator star = build_estimators(*test::full_frame(21, 21), scene.model(),
                                              settings_of(PhotometryMethod::kMask, BackgroundMethod::kKnown))[0];
  EXPECT_GT(star.spr_total, 1e-3);
  EXPECT_NE(star.flags & measurement_flag::kContaminated, 0U);
}

TEST(Estimators, OfOneStarDoNotChangeWithAStarFarAway) {
  test::GroundScene scene = scene_with_noise();
  scene.add_target({10.3, 10.1}, 1e5);
  scene.add_star({12.3, 11.1}, 3e4);
  const PhotometrySettings settings = settings_of(PhotometryMethod::kMask, BackgroundMethod::kLocal);
  const auto layout = test::full_frame(81, 21);
  const StarEstimator before = build_estimators(*layout, scene.model(), settings)[0];
  scene.add_star({70.0, 10.0}, 1e8);
  scene.add_target({60.0, 12.0}, 2e5);
  const StarEstimator after = build_estimators(*layout, scene.model(), settings)[0];
  EXPECT_EQ(before.offset, after.offset);
  EXPECT_EQ(before.nsr_exposure, after.nsr_exposure);
  EXPECT_EQ(before.spr_total, after.spr_total);
  EXPECT_EQ(before.gradient_x, after.gradient_x);
  ASSERT_EQ(before.terms.size(), after.terms.size());
  for (std::size_t i = 0; i < before.terms.size(); ++i) {
    EXPECT_EQ(before.terms[i].pixel, after.terms[i].pixel);
    EXPECT_EQ(before.terms[i].weight, after.terms[i].weight);
  }
}

TEST(Estimators, LeaveOutLessThanTheAccuracyOfABrightNeighboursWing) {
  // A neighbour 8 magnitudes brighter: its stamp must be wider than that of the faint target.
  test::GroundScene scene = scene_with_noise();
  constexpr double kFaint = 4000.0;
  scene.add_target({20.0, 20.0}, kFaint);
  scene.add_star({24.6, 20.0}, 1600.0 * kFaint);
  const auto layout = test::full_frame(41, 41);
  const StarEstimator star =
      build_estimators(*layout, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kKnown))[0];
  test::GroundScene neighbour = scene;
  neighbour.stars.erase(neighbour.stars.begin());
  neighbour.noise.background = 0.0;
  const std::vector<double> light = test::expected_electrons(*layout, neighbour);
  double all = 0.0;
  for (const EstimatorTerm& term : star.terms) all += static_cast<double>(term.weight) * light[term.pixel];
  EXPECT_GT(all, 0.0);
  EXPECT_NEAR(star.budget.contaminants, all, 1e-6 * kFaint);
}

}  // namespace
}  // namespace astroid
