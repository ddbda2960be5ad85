#include "astroid/analysis/contamination.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace astroid {
namespace {

/// The estimator of star 0 with a mask of the 3 × 3 pixels around (2, 2) in a 6 × 6 region at (10, 20).
StarEstimator square_mask(const PixelPsf& psf, std::span<const FieldStar> stars) {
  StarEstimator e;
  for (std::uint32_t y = 1; y <= 3; ++y) {
    for (std::uint32_t x = 1; x <= 3; ++x) e.terms.push_back({6 * y + x, 1.0F});
  }
  e.aperture_terms = e.terms.size();
  e.terms.push_back({35, -1.0F});  // a background pixel, which does not count
  std::vector<double> p(9);
  for (std::size_t s = 0; s < stars.size(); ++s) {
    psf.integrate(stars[s].position, {11, 21, 3, 3}, p);
    double enclosed = 0.0;
    for (const double v : p) enclosed += v;
    (s == 0 ? e.budget.target : e.budget.contaminants) += stars[s].electrons * enclosed;
  }
  return e;
}

TEST(StrongestContaminants, AddUpToTheWholeAndComeInFallingOrder) {
  const auto psf = make_gaussian_psf(0.6);
  const PixelLayout layout({{10, 20, 6, 6}});
  const std::vector<FieldStar> stars{
      {"T", {12.0, 22.0}, 1e5}, {"weak", {14.0, 22.0}, 1e5}, {"strong", {12.5, 22.5}, 1e5}, {"far", {40.0, 22.0}, 1e9}};
  const std::vector<StarEstimator> estimators{square_mask(*psf, stars)};
  GroundModel model;
  model.stars = stars;
  model.psf = psf.get();
  const auto lists = strongest_contaminants(estimators, layout, model, 8.0, 5);
  ASSERT_EQ(lists.size(), 1U);
  ASSERT_EQ(lists[0].size(), 2U);
  EXPECT_EQ(lists[0][0].id, "strong");
  EXPECT_DOUBLE_EQ(lists[0][0].dx, 0.5);
  EXPECT_EQ(lists[0][1].id, "weak");
  const EstimatorBudget& budget = estimators[0].budget;
  EXPECT_NEAR(lists[0][0].spr + lists[0][1].spr, budget.contaminants / (budget.target + budget.contaminants), 1e-12);
}

TEST(StrongestContaminants, StopAtTheCountAskedFor) {
  const auto psf = make_gaussian_psf(0.6);
  const PixelLayout layout({{10, 20, 6, 6}});
  std::vector<FieldStar> stars{{"T", {12.0, 22.0}, 1e5}};
  for (int i = 0; i < 10; ++i) stars.push_back({"n" + std::to_string(i), {12.0 + 0.1 * i, 23.0}, 1000.0});
  const std::vector<StarEstimator> estimators{square_mask(*psf, stars), StarEstimator{}};
  GroundModel model;
  model.stars = stars;
  model.psf = psf.get();
  const auto lists = strongest_contaminants(estimators, layout, model, 8.0, 3);
  EXPECT_EQ(lists[0].size(), 3U);
  EXPECT_TRUE(lists[1].empty());  // a star without an aperture
}

// An eclipsing binary of 13.2 %, 6.72 h scaled by 0.46², seen three times (DAP).
constexpr TransitSeries kEclipses{0.132, 6.72 * 0.46 * 0.46, 3.0};

TEST(Significance, GivesThePublishedCriticalShare) {
  EXPECT_NEAR(critical_spr(kEclipses, 0.0, 50e-6, kDetectionThreshold), 1.30212e-3, 5e-9);
}

TEST(Significance, ReachesTheThresholdAtTheCriticalShare) {
  const double critical = critical_spr(kEclipses, 0.02, 80e-6, kDetectionThreshold);
  EXPECT_NEAR(contaminant_significance(kEclipses, critical, 0.02, 80e-6), kDetectionThreshold, 1e-12);
}

TEST(Significance, OfAnEarthIsThePublishedOne) {
  constexpr TransitSeries kEarth{84e-6, 13.0, 3.0};
  EXPECT_NEAR(planet_significance(kEarth, 34e-6), 15.4288, 5e-5);
  EXPECT_NEAR(planet_significance(kEarth, 50e-6), 10.4916, 5e-5);
  EXPECT_NEAR(planet_significance(kEarth, 80e-6), 6.5572, 5e-5);
}

}  // namespace
}  // namespace astroid
