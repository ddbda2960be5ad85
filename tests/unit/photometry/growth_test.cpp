#include "astroid/photometry/growth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/error.hpp"
#include "astroid/photometry/found_stars.hpp"
#include "astroid/photometry/scene_choice.hpp"
#include "astroid/test/ground_scene.hpp"
#include "astroid/test/star_field.hpp"

namespace astroid {
namespace {

TEST(GrowthCurve, IsThatOfAGaussianWithinItsError) {
  test::StarFieldSettings settings;
  settings.stars = 120;
  settings.slope = 0.1;
  const test::StarField field = test::make_star_field(settings);
  std::vector<PixelPosition> places;
  std::vector<double> light;
  for (const test::TrueStar& star : field.stars) {
    places.push_back({star.x, star.y});
    light.push_back(star.flux);
  }
  const GrowthCurve curve = measure_growth(field.frame, BackgroundMap(field.frame, 0, {}), places, light, {});
  ASSERT_EQ(curve.light.size(), 9U);
  EXPECT_EQ(curve.light.back(), 1.0);
  EXPECT_EQ(curve.error.back(), 0.0);
  // A disc of radius r holds 1 - exp(-r²/2σ²) of a Gaussian; the pixel widens it by 1/12 px².
  const double variance = 2.5 * 2.5 / (2.3548200450309493 * 2.3548200450309493) + 1.0 / 12.0;
  const double expected = 1.0 - std::exp(-9.0 / (2.0 * variance));
  EXPECT_NEAR(curve.light.front(), expected, 4.0 * curve.error.front() + 0.001);
  EXPECT_LT(curve.error.front(), 0.003);
}

TEST(GrowthCurve, NeedsStarsAndRadii) {
  const test::StarField field = test::make_star_field({});
  const BackgroundMap map(field.frame, 0, {});
  EXPECT_TRUE(measure_growth(field.frame, map, {}, {}, {}).light.empty());
  GrowthSettings settings;
  settings.reference = settings.radius;
  EXPECT_THROW((void)measure_growth(field.frame, map, {}, {}, settings), InputError);
}

TEST(FoundStars, AreMeasuredToTheirTrueFluxes) {
  test::StarFieldSettings settings;
  settings.stars = 300;
  settings.slope = 0.1;
  const test::StarField field = test::make_star_field(settings);
  FoundStarsSettings find;
  find.measure.background = BackgroundMethod::kMesh;
  const FoundStars found = measure_found_stars(field.frame, nullptr, find);
  EXPECT_NEAR(found.radius, 3.0, 0.1) << "1.2 FWHM of a sparse field";
  EXPECT_GT(found.correction, 1.01);
  EXPECT_GE(found.correction_stars, 5U);
  std::vector<double> pulls;
  for (const SourceMeasurement& source : found.sources) {
    if (source.flags != 0 || source.crowding > 0.001) continue;
    EXPECT_GT(source.position_err, 0.0);
    EXPECT_TRUE(std::isfinite(source.sharpness));
    for (const test::TrueStar& star : field.stars)
      if (std::hypot(star.x - source.x, star.y - source.y) < 0.5 && star.flux > 1000.0)
        pulls.push_back((source.flux - star.flux) / std::hypot(source.flux_err, star.flux * found.correction_error));
  }
  ASSERT_GT(pulls.size(), 50U);
  std::sort(pulls.begin(), pulls.end());
  const double median = pulls[pulls.size() / 2];
  EXPECT_LT(std::abs(median), 1.0);
  EXPECT_LT(pulls[pulls.size() * 84 / 100] - median, 1.6) << "unseen neighbours widen it a little";
}

TEST(MeasuredGain, IsThatOfASkyWithAGradient) {
  const test::TestNoise noise(31);
  Frame frame = test::empty_frame(test::full_frame(512, 512));
  constexpr double kGain = 2.5;  // e-/ADU
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      const double photons = 1000.0 + 2.0 * x;
      const double counts =
          photons + std::sqrt(photons + 25.0) * noise.normal(5, static_cast<std::uint32_t>(512 * y + x));
      frame.pixels.view(0).at(x, y) = static_cast<float>(counts / kGain + 300.0);
    }
  }
  const auto gain = measure_gain(BackgroundMap(frame, 0, {}));
  ASSERT_TRUE(gain.has_value());
  EXPECT_NEAR(gain->gain, kGain, 4.0 * gain->error);
  EXPECT_LT(gain->error, 0.1 * kGain);
}

TEST(MeasuredGain, IsNotToldByAnEvenSky) {
  const test::StarField field = test::make_star_field({});
  EXPECT_FALSE(measure_gain(BackgroundMap(field.frame, 0, {})).has_value());
}

TEST(ChooseMethod, SaysWhy) {
  ImageScene scene{.stars = 100, .fwhm = 2.5, .neighbours = 0.05};
  EXPECT_EQ(choose_method(scene).method, PhotometryMethod::kAperture);
  scene.psf_given = true;
  EXPECT_EQ(choose_method(scene).method, PhotometryMethod::kPsf);
  scene.catalogue = true;
  scene.fwhm = 1.2;
  EXPECT_EQ(choose_method(scene).method, PhotometryMethod::kWeighted);
  EXPECT_NE(choose_method(scene).why.find("undersampled"), std::string::npos);
  scene.neighbours = 0.6;
  EXPECT_EQ(choose_method(scene).method, PhotometryMethod::kPsf);
  EXPECT_NE(choose_method(scene).why.find("60 % of 100 stars"), std::string::npos);
}

}  // namespace
}  // namespace astroid
