// The fit of few stars as the oracle of the solver of whole fields: another minimiser of the same chi².
#include "astroid/photometry/group_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/core/units.hpp"
#include "astroid/test/star_field.hpp"
#include "field/field_fit.hpp"
#include "field/field_pixels.hpp"
#include "field/local_fit.hpp"

namespace astroid {
namespace {

TEST(GroupFit, IsTheFieldSolversOracle) {
  constexpr int kSide = 64;
  // As crowded as 15,000 stars on 1024² px.
  const test::StarField field =
      test::make_star_field({.nx = kSide, .ny = kSide, .stars = 58, .fwhm = 2.5, .slope = 0.25, .seed = 3});
  const auto psf = make_gaussian_psf(2.5 / kFwhmPerSigma);
  constexpr int kMargin = 48;
  const detail::FieldPixels pixels = detail::field_pixels(field.frame, {}, kMargin);
  const detail::PsfReach reach(*psf, {0.5 * kSide, 0.5 * kSide}, 40);
  const detail::FieldFitSettings settings;
  detail::FieldFit fit(*psf, reach, pixels, settings);
  fit.run();
  // To the end, where the field's solver stops when fluxes stay within a tenth of their errors.
  for (int i = 0; i < 20; ++i) {
    (void)fit.solver().step(1e-6, 1000);
    fit.solver().render();
    fit.solver().assemble();
  }
  const detail::FieldSolver& solver = fit.solver();
  ASSERT_GT(solver.stars().size(), 20U);

  GroupPixels group;
  group.box = {0, 0, kSide, kSide};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double sky = solver.sky_at(x, y);
      group.electrons.push_back(static_cast<double>(*pixels.electrons.at(x, y)) - sky);
      group.variance.push_back(std::max(0.0, sky) + pixels.read_variance);
      group.usable.push_back(1);
    }
  std::vector<GroupStar> stars;
  for (const detail::ModelStar& star : solver.stars())
    stars.push_back({{star.x + 0.05, star.y - 0.05}, 1.1 * star.flux});
  GroupFitSettings careful;
  careful.fit_background = false;  // the field's sky is taken as it is
  careful.outlier = 20.0;
  const GroupFit oracle = fit_group(group, *psf, stars, careful);
  EXPECT_EQ(oracle.outliers, 0U);
  detail::LocalFit local(solver);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const detail::ModelStar& ours = solver.stars()[i];
    const FittedStar& theirs = oracle.stars[i];
    if (theirs.flags != 0U) continue;
    ++compared;
    const double error = std::sqrt(theirs.covariance[0]);
    EXPECT_NEAR(ours.flux, theirs.flux, 0.02 * error) << i;
    // The field's pixels are of single precision, and its sky moves on: the faintest stars notice.
    EXPECT_NEAR(ours.x, theirs.position.x, 0.05 * std::sqrt(theirs.covariance[3])) << i;
    EXPECT_NEAR(ours.y, theirs.position.y, 0.05 * std::sqrt(theirs.covariance[5])) << i;
    // The field's covariance knows the nearest eight neighbours only, and a sky that is known.
    EXPECT_NEAR(std::sqrt(local.covariance(i).covariance[0]) / error, 1.0, 0.02) << i;
    EXPECT_NEAR(std::sqrt(local.covariance(i).covariance[3] / theirs.covariance[3]), 1.0, 0.02) << i;
  }
  EXPECT_GT(compared, (9 * stars.size()) / 10);
}

}  // namespace
}  // namespace astroid
