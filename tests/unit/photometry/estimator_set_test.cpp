// Estimators applied to frames, with a naive sum as the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Measured {
  std::vector<double> flux;
  std::vector<std::uint32_t> flags;
};

Measured measure(const std::vector<StarEstimator>& estimators, const Frame& frame) {
  const EstimatorSet set(estimators, frame.header.gain, frame.header.bias);
  Measured measured{std::vector<double>(set.size(), -1.0), std::vector<std::uint32_t>(set.size())};
  set.apply(frame, measured.flux, measured.flags);
  return measured;
}

// The definition, term by term in long double: sum w c g - (sum w) (mean of background) - offset.
double naive(const StarEstimator& estimator, const Frame& frame) {
  const long double gain = frame.header.gain.value();
  long double sum = 0.0L;
  long double weights = 0.0L;
  long double level = 0.0L;
  for (std::size_t i = 0; i < estimator.terms.size(); ++i) {
    const long double electrons = gain * (static_cast<long double>(frame.pixels.pixels()[estimator.terms[i].pixel]) -
                                          static_cast<long double>(frame.header.bias.value()));
    if (i < estimator.aperture_terms) {
      sum += static_cast<long double>(estimator.terms[i].weight) * electrons;
      weights += static_cast<long double>(estimator.terms[i].weight);
    } else {
      level += electrons / static_cast<long double>(estimator.terms.size() - estimator.aperture_terms);
    }
  }
  return static_cast<double>(sum - weights * level - static_cast<long double>(estimator.offset));
}

test::GroundScene crowded_scene() {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.7);
  scene.noise = {945.0, 50.2, 7.2};
  scene.gain = Gain(25.0);
  scene.bias = Adu(1000.0);
  const test::TestNoise noise(3);
  for (std::uint32_t i = 0; i < 60; ++i)
    scene.add_target({1.0 + 58.0 * noise.uniform(0, i), 1.0 + 48.0 * noise.uniform(1, i)},
                     3000.0 * std::exp(5.0 * noise.uniform(2, i)));
  return scene;
}

PhotometrySettings settings_of(PhotometryMethod method, BackgroundMethod background) {
  PhotometrySettings settings;
  settings.method = method;
  settings.background = background;
  return settings;
}

TEST(EstimatorSet, SumsLikeTheDefinition) {
  const test::GroundScene scene = crowded_scene();
  const auto layout = test::full_frame(60, 50);
  const Frame frame = test::noisy_frame(layout, scene, test::expected_electrons(*layout, scene), test::TestNoise(4), 0);
  for (const PhotometryMethod method :
       {PhotometryMethod::kAperture, PhotometryMethod::kMask, PhotometryMethod::kWeighted, PhotometryMethod::kPsf}) {
    for (const BackgroundMethod background :
         {BackgroundMethod::kKnown, BackgroundMethod::kLocal, BackgroundMethod::kMesh}) {
      const auto estimators = build_estimators(*layout, scene.model(), settings_of(method, background));
      const Measured measured = measure(estimators, frame);
      for (std::size_t i = 0; i < estimators.size(); ++i)
        EXPECT_NEAR(measured.flux[i], naive(estimators[i], frame), 1e-13 * 1e7);
    }
  }
}

TEST(EstimatorSet, MeasuresTheExpectedFluxOnANoiselessFrame) {
  const test::GroundScene scene = crowded_scene();
  const auto layout = test::full_frame(60, 50);
  // Counts are floats: 24 bits of up to 1e6 ADU leave 1e-7 of the brightest pixel.
  const Frame frame = test::frame_of(layout, scene, test::expected_electrons(*layout, scene));
  for (const PhotometryMethod method :
       {PhotometryMethod::kAperture, PhotometryMethod::kMask, PhotometryMethod::kWeighted, PhotometryMethod::kPsf}) {
    for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
      const auto estimators = build_estimators(*layout, scene.model(), settings_of(method, background));
      const Measured measured = measure(estimators, frame);
      for (std::size_t i = 0; i < estimators.size(); ++i) {
        const EstimatorBudget& budget = estimators[i].budget;
        EXPECT_NEAR(measured.flux[i], budget.target + budget.contaminants, 1.0) << i;
        EXPECT_EQ(measured.flags[i], estimators[i].flags);
      }
    }
  }
}

TEST(EstimatorSet, IgnoresTheBackgroundWhenItIsLocal) {
  const test::GroundScene scene = crowded_scene();
  const auto layout = test::full_frame(60, 50);
  const auto estimators =
      build_estimators(*layout, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kLocal));
  std::vector<double> electrons = test::expected_electrons(*layout, scene);
  const Measured before = measure(estimators, test::frame_of(layout, scene, electrons));
  for (double& value : electrons) value += 12800.0;  // 512 ADU: exact in a float
  const Measured after = measure(estimators, test::frame_of(layout, scene, electrons));
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    if ((estimators[i].flags & measurement_flag::kNoBackground) != 0U) continue;
    EXPECT_NEAR(after.flux[i], before.flux[i], 0.5);
  }
}

TEST(EstimatorSet, ReadsTheSameFluxFromAWindowAsFromTheFullFrame) {
  const test::GroundScene scene = crowded_scene();
  const auto full = test::full_frame(60, 50);
  std::vector<Rectangle> regions;
  for (const FieldStar& star : scene.stars) {
    const Rectangle window = mask_window(star.position, 20);
    regions.push_back(intersect(window, {0, 0, 60, 50}));
  }
  const auto windows = std::make_shared<const PixelLayout>(regions);
  const PhotometrySettings settings = settings_of(PhotometryMethod::kMask, BackgroundMethod::kLocal);
  const auto on_full = build_estimators(*full, scene.model(), settings);
  const auto on_windows = build_estimators(*windows, scene.model(), settings);
  const Frame full_frame =
      test::noisy_frame(full, scene, test::expected_electrons(*full, scene), test::TestNoise(5), 0);
  Frame window_frame = test::empty_frame(windows, scene.gain, scene.bias);
  for (std::size_t r = 0; r < regions.size(); ++r)
    for (int y = regions[r].y0; y < regions[r].y1(); ++y)
      for (int x = regions[r].x0; x < regions[r].x1(); ++x)
        window_frame.pixels.view(r).at(x, y) = full_frame.pixels.view(0).at(x, y);
  const Measured from_full = measure(on_full, full_frame);
  const Measured from_windows = measure(on_windows, window_frame);
  for (std::size_t i = 0; i < on_full.size(); ++i) {
    EXPECT_EQ(from_full.flux[i], from_windows.flux[i]) << i;
    EXPECT_EQ(from_full.flags[i], from_windows.flags[i]) << i;
    EXPECT_EQ(on_full[i].nsr_exposure, on_windows[i].nsr_exposure);
    EXPECT_EQ(on_full[i].spr_total, on_windows[i].spr_total);
  }
}

TEST(EstimatorSet, FlagsSaturatedAndBadPixelsOfTheApertureOnly) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({10.0, 10.0}, 1e5);
  scene.add_target({30.0, 10.0}, 1e5);
  const auto layout = test::full_frame(41, 21);
  const auto estimators =
      build_estimators(*layout, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kLocal));
  Frame frame = test::frame_of(layout, scene, test::expected_electrons(*layout, scene));
  frame.flags.view(0).at(10, 10) = pixel_flag::kFullWell;
  frame.flags.view(0).at(11, 10) = pixel_flag::kBad;
  frame.flags.view(0).at(13, 13) = pixel_flag::kAdcSaturated;  // not in the mask
  const Measured measured = measure(estimators, frame);
  EXPECT_EQ(measured.flags[0], measurement_flag::kSaturated | measurement_flag::kBadPixel);
  EXPECT_EQ(measured.flags[1], 0U);
  EXPECT_TRUE(std::isfinite(measured.flux[0]));
}

TEST(EstimatorSet, GivesNanForAnUnusablePixelAndLeavesOtherStarsAlone) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({10.0, 10.0}, 1e5);
  scene.add_target({30.0, 10.0}, 1e5);
  const auto layout = test::full_frame(41, 21);
  const auto estimators =
      build_estimators(*layout, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kKnown));
  Frame frame = test::frame_of(layout, scene, test::expected_electrons(*layout, scene));
  const double clean = measure(estimators, frame).flux[1];
  for (const float bad : {kNan, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
    frame.pixels.view(0).at(10, 11) = bad;
    const Measured measured = measure(estimators, frame);
    EXPECT_TRUE(std::isnan(measured.flux[0]));
    EXPECT_EQ(measured.flags[0], measurement_flag::kBadPixel);
    EXPECT_EQ(measured.flux[1], clean);
    EXPECT_EQ(measured.flags[1], 0U);
  }
}

TEST(EstimatorSet, LeavesSpoiltBackgroundPixelsOut) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.noise = {945.0, 50.2, 7.2};
  scene.gain = Gain(2.0);
  scene.bias = Adu(100.0);
  scene.add_target({20.0, 20.0}, 1e5);
  const auto layout = test::full_frame(41, 41);
  const auto estimators =
      build_estimators(*layout, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kLocal));
  Frame frame = test::frame_of(layout, scene, test::expected_electrons(*layout, scene));
  const double clean = measure(estimators, frame).flux[0];
  frame.pixels.view(0).at(26, 20) = kNan;
  frame.pixels.view(0).at(20, 26) = 60000.0F;
  frame.flags.view(0).at(20, 26) = pixel_flag::kBad;
  Measured measured = measure(estimators, frame);
  EXPECT_NEAR(measured.flux[0], clean, 0.1);
  EXPECT_EQ(measured.flags[0], 0U);
  // Saturation also spoils what the model expects of the pixels around it.
  frame.flags.view(0).at(20, 26) = pixel_flag::kAdcSaturated;
  measured = measure(estimators, frame);
  EXPECT_NEAR(measured.flux[0], clean, 0.1);
  EXPECT_EQ(measured.flags[0], measurement_flag::kSpoiltBackground);
  // Without enough of them the known background stands in.
  for (std::size_t i = estimators[0].aperture_terms; i < estimators[0].terms.size(); ++i)
    frame.flags.pixels()[estimators[0].terms[i].pixel] = pixel_flag::kBad;
  measured = measure(estimators, frame);
  EXPECT_NEAR(measured.flux[0], clean, 0.1);
  EXPECT_EQ(measured.flags[0], measurement_flag::kNoBackground);
}

TEST(EstimatorSet, OfNoTargetsMeasuresNothing) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  const auto layout = test::full_frame(8, 8);
  const auto estimators = build_estimators(*layout, scene.model(), PhotometrySettings{});
  EXPECT_TRUE(estimators.empty());
  EXPECT_TRUE(measure(estimators, test::empty_frame(layout)).flux.empty());
}

TEST(BuildEstimators, RefusesSettingsThatContradictThemselvesOrTheLayout) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.add_target({4.0, 4.0}, 1e4);
  const auto layout = test::full_frame(8, 8);
  PhotometrySettings settings = settings_of(PhotometryMethod::kAperture, BackgroundMethod::kLocal);
  settings.aperture_radius = Pixels(0.0);
  settings.annulus_outer = Pixels(4.0);
  try {
    (void)build_estimators(*layout, scene.model(), settings);
    FAIL() << "an aperture of radius 0 was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2U) << "every problem in one go";
  }
  const PixelLayout windows({{0, 0, 4, 4}, {4, 4, 4, 4}});
  EXPECT_THROW(
      (void)build_estimators(windows, scene.model(), settings_of(PhotometryMethod::kMask, BackgroundMethod::kMesh)),
      InputError);
  settings = settings_of(PhotometryMethod::kMask, BackgroundMethod::kKnown);
  settings.mask_window = 0;
  EXPECT_THROW((void)build_estimators(*layout, scene.model(), settings), InputError);
}

}  // namespace
}  // namespace astroid
