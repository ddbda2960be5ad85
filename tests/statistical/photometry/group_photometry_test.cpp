// Fits of few stars at the places of a catalogue: honest errors, and flags for what cannot be measured.
#include "astroid/photometry/group_photometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/test/star_field.hpp"

namespace astroid {
namespace {

std::vector<SourceRequest> catalogue_of(const test::StarField& field, double off) {
  std::vector<SourceRequest> requests;
  for (const test::TrueStar& star : field.stars)
    requests.push_back(
        {.id = std::to_string(requests.size()), .pixel = PixelPosition{star.x + off, star.y - off}, .sky = {}});
  return requests;
}

double width_of(std::vector<double> pulls) {
  for (double& p : pulls) p = std::abs(p);
  const auto middle = pulls.begin() + static_cast<std::ptrdiff_t>(pulls.size() / 2);
  std::nth_element(pulls.begin(), middle, pulls.end());
  return 1.4826 * *middle;
}

TEST(GroupPhotometry, HasHonestErrorsOfFluxesAndPlaces) {
  const test::StarField field =
      test::make_star_field({.nx = 384, .ny = 384, .stars = 500, .slope = 0.1, .faint = 18.5, .seed = 21});
  GroupPhotometrySettings settings;
  settings.psf = make_gaussian_psf(2.5 / kFwhmPerSigma);
  const auto sources = measure_groups(field.frame, nullptr, catalogue_of(field, 0.15), settings);
  std::vector<double> flux;
  std::vector<double> place;
  std::size_t unflagged = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const SourceMeasurement& s = sources[i];
    if (s.flags != 0U) continue;
    ++unflagged;
    flux.push_back((s.flux - field.stars[i].flux) / s.flux_err);
    place.push_back((s.x - field.stars[i].x) / s.position_err);
    place.push_back((s.y - field.stars[i].y) / s.position_err);
  }
  ASSERT_GT(unflagged, 450U);
  // The relative error of such a width is 1.17 / sqrt(n).
  const auto n = static_cast<double>(flux.size());
  EXPECT_NEAR(width_of(flux), 1.0, 3.0 * 1.17 / std::sqrt(n));
  EXPECT_NEAR(width_of(place), 1.0, 0.02 + 3.0 * 1.17 / std::sqrt(2.0 * n));
}

TEST(GroupPhotometry, FlagsWhatItCannotMeasureAndGoesOn) {
  test::StarField field =
      test::make_star_field({.nx = 96, .ny = 96, .stars = 25, .slope = 0.1, .faint = 17.0, .seed = 8});
  auto requests = catalogue_of(field, 0.0);
  requests.push_back(requests[0]);  // twice in the catalogue
  requests.push_back({.id = "outside", .pixel = PixelPosition{-30.0, 5.0}, .sky = {}});
  requests.push_back(
      {.id = "nowhere", .pixel = PixelPosition{std::numeric_limits<double>::quiet_NaN(), 5.0}, .sky = {}});
  requests.push_back({.id = "hole", .pixel = PixelPosition{60.0, 60.0}, .sky = {}});
  for (int y = 50; y <= 70; ++y)
    for (int x = 50; x <= 70; ++x) field.frame.pixels.view(0).at(x, y) = std::numeric_limits<float>::quiet_NaN();
  GroupPhotometrySettings settings;
  settings.psf = make_gaussian_psf(2.5 / kFwhmPerSigma);
  const auto sources = measure_groups(field.frame, nullptr, requests, settings);
  ASSERT_EQ(sources.size(), requests.size());
  for (const SourceMeasurement& s : sources) {
    if (!std::isfinite(s.flux)) {
      EXPECT_NE(s.flags, 0U) << s.id;
    }
  }
  EXPECT_NE(sources[0].flags & measurement_flag::kMerged, 0U);
  EXPECT_NE(sources[25].flags & measurement_flag::kMerged, 0U);
  EXPECT_EQ(sources[26].flags, measurement_flag::kOutside);
  EXPECT_EQ(sources[27].flags, measurement_flag::kOutside);
  EXPECT_NE(sources[28].flags & measurement_flag::kBadPixel, 0U);
  EXPECT_TRUE(std::isnan(sources[28].flux));
}

TEST(GroupPhotometry, NeedsAPsf) {
  const test::StarField field = test::make_star_field({.nx = 32, .ny = 32, .stars = 1});
  EXPECT_THROW(measure_groups(field.frame, nullptr, catalogue_of(field, 0.0), {}), InputError);
}

}  // namespace
}  // namespace astroid
