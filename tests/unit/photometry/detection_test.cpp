#include "astroid/photometry/detection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/test/star_field.hpp"

namespace astroid {
namespace {

test::StarField field_of(int stars, double fwhm, std::uint64_t seed, double slope = 0.1) {
  test::StarFieldSettings settings;
  settings.stars = stars;
  settings.fwhm = fwhm;
  settings.slope = slope;
  settings.seed = seed;
  return test::make_star_field(settings);
}

TEST(MeasureFwhm, IsThatOfTheStars) {
  for (const double fwhm : {1.3, 2.0, 2.5, 4.0, 6.0}) {
    const test::StarField field = field_of(300, fwhm, 4);
    EXPECT_NEAR(measure_fwhm(field.frame, BackgroundMap(field.frame, 0, {})) / fwhm, 1.0, 0.05) << fwhm;
  }
}

TEST(MeasureFwhm, OfNoStarsIsNotANumber) {
  const test::StarField field = field_of(0, 2.5, 5);
  EXPECT_TRUE(std::isnan(measure_fwhm(field.frame, BackgroundMap(field.frame, 0, {}))));
}

TEST(DetectStars, FindsThemWhereTheyAreWithinTheirErrors) {
  const test::StarField field = field_of(250, 2.5, 6);
  const Detection found = detect_stars(field.frame, BackgroundMap(field.frame, 0, {}), {});
  int bright = 0;
  double squares = 0.0;
  for (const test::TrueStar& star : field.stars) {
    const auto lonely = std::count_if(field.stars.begin(), field.stars.end(), [&](const test::TrueStar& other) {
      return std::hypot(other.x - star.x, other.y - star.y) < 12.0;
    });
    if (lonely > 1 || star.flux < 600.0 || std::min(star.x, star.y) < 8 || std::max(star.x, star.y) > 503) continue;
    ++bright;
    const auto nearest =
        std::min_element(found.stars.begin(), found.stars.end(), [&](const DetectedStar& a, const DetectedStar& b) {
          return std::hypot(a.x - star.x, a.y - star.y) < std::hypot(b.x - star.x, b.y - star.y);
        });
    ASSERT_NE(nearest, found.stars.end());
    const double dx = (nearest->x - star.x) / nearest->position_error;
    const double dy = (nearest->y - star.y) / nearest->position_error;
    EXPECT_LT(std::hypot(dx, dy), 7.0) << star.x << ", " << star.y << ": " << star.flux;
    squares += dx * dx + dy * dy;
  }
  ASSERT_GT(bright, 60);
  // The width of 2 n pulls scatters by 1 / √(4 n); the top of a parabola adds a little.
  EXPECT_NEAR(std::sqrt(squares / (2.0 * bright)), 1.0, 0.1 + 3.0 / std::sqrt(4.0 * bright));
}

TEST(DetectStars, MakesNoStarsOfNoise) {
  int total = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const test::StarField field = field_of(0, 2.5, seed);
    total += static_cast<int>(detect_stars(field.frame, BackgroundMap(field.frame, 0, {}), {}).stars.size());
  }
  // A million pixels above 5 sigma of skewed noise: less than one expected.
  EXPECT_LE(total, 3);
}

TEST(DetectStars, TellsTwoStarsApart) {
  test::StarFieldSettings settings;
  settings.nx = 64;
  settings.ny = 64;
  settings.fwhm = 2.5;
  Frame frame = test::make_star_field(settings).frame;
  const auto add = [&](double x0, double flux) {
    for (int y = 20; y < 45; ++y)
      for (int x = 20; x < 45; ++x) {
        const double r2 = (x - x0) * (x - x0) + (y - 32.0) * (y - 32.0);
        frame.pixels.view(0).at(x, y) += static_cast<float>(flux * 0.14 * std::exp(-r2 / 2.254));
      }
  };
  add(30.0, 20000.0);
  add(34.5, 6000.0);
  const Detection found = detect_stars(frame, BackgroundMap(frame, 0, {}), {});
  EXPECT_EQ(found.stars.size(), 2U);
}

TEST(DetectStars, SurvivesWhatIsNoImageOfStars) {
  test::StarFieldSettings settings;
  for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 50}, {50, 1}, {3, 3}, {40, 40}}) {
    settings.nx = nx;
    settings.ny = ny;
    Frame frame = test::make_star_field(settings).frame;
    EXPECT_LE(detect_stars(frame, BackgroundMap(frame, 0, {}), {}).stars.size(), 2U);
    for (float& v : frame.pixels.pixels()) v = 7.0F;
    EXPECT_TRUE(detect_stars(frame, BackgroundMap(frame, 0, {}), {}).stars.empty());
    for (float& v : frame.pixels.pixels()) v = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(detect_stars(frame, BackgroundMap(frame, 0, {}), {}).stars.empty());
  }
}

TEST(DetectStars, RefusesThresholdsThatMeanNothing) {
  const test::StarField field = field_of(0, 2.5, 1);
  const BackgroundMap map(field.frame, 0, {});
  DetectionSettings settings;
  settings.threshold = 0.0;
  EXPECT_THROW((void)detect_stars(field.frame, map, settings), InputError);
  settings.threshold = 1.0;
  settings.footprint = 2.0;
  EXPECT_THROW((void)detect_stars(field.frame, map, settings), InputError);
}

}  // namespace
}  // namespace astroid
