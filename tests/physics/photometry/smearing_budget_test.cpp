// What smearing does to the flux of a star, and what its correction costs: the numbers of a bright star in the column.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/column_light.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

// PLATO's camera: 4510 rows read in 4.019 s after 21 s, zero point 20.62 e-/s, sigma 0.6 px.
constexpr int kRows = 4510;
constexpr double kExposure = 21.0;
constexpr double kReadoutTime = 4.019;
constexpr int kOverscanRows = 30;

double electrons(double magnitude) {
  return kExposure * std::pow(10.0, -0.4 * (magnitude - 20.62));
}

// A target of P = 11 at the centre of a pixel, a star of P = 2 a thousand rows away in the same column.
test::GroundScene scene() {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.gain = Gain(7.2 * std::sqrt(12.0));
  scene.noise = {945.0, 50.2, 7.2};
  scene.add_target({20.0, 20.0}, electrons(11.0));
  return scene;
}

std::vector<double> smeared(const test::GroundScene& scene, int columns) {
  std::vector<double> light(static_cast<std::size_t>(columns), 0.0);
  std::vector<double> scratch;
  const Rectangle detector{0, 0, columns, kRows};
  const double share = clocking_share(kReadoutTime, kExposure, kRows);
  for (const StarLight& star :
       {StarLight{.centre = {20.0, 20.0}, .electrons = electrons(11.0) * share, .half_width = 6.0},
        StarLight{.centre = {20.0, 1020.0}, .electrons = electrons(2.0) * share, .half_width = 6.0}})
    add_column_light(*scene.psf, star, detector, 0, light, scratch);
  return light;
}

// The fixed mask of 3 × 3 px: what is best without smearing.
PhotometrySettings fixed_mask() {
  PhotometrySettings settings;
  settings.method = PhotometryMethod::kMask;
  settings.mask_window = 3;
  settings.background = BackgroundMethod::kKnown;
  return settings;
}

StarEstimator build(const GroundModel& model, const PhotometrySettings& settings) {
  return build_estimators(*test::full_frame(41, 41), model, settings).front();
}

TEST(SmearingBudget, OfABrightStarInTheColumnIsHalfAMagnitude) {
  const test::GroundScene s = scene();
  GroundModel model = s.model();
  const StarEstimator without = build(model, fixed_mask());
  ASSERT_EQ(without.mask_pixels, 9);
  EXPECT_NEAR(without.nsr_exposure, 2.907e-3, 0.001e-3);
  EXPECT_EQ(without.budget.smearing, 0.0);
  EXPECT_EQ(without.budget.var_smearing + without.budget.var_smearing_correction, 0.0);

  model.smearing.electrons = smeared(s, 41);
  const StarEstimator uncorrected = build(model, fixed_mask());
  ASSERT_EQ(uncorrected.mask_pixels, 9);
  const double share = uncorrected.budget.smearing / uncorrected.budget.target;
  EXPECT_NEAR(share, 0.513, 0.0005);
  EXPECT_NEAR(-2.5 * std::log10(1.0 + share), -0.450, 0.0005);

  model.smearing.overscan_rows = kOverscanRows;
  const StarEstimator corrected = build(model, fixed_mask());
  ASSERT_EQ(corrected.mask_pixels, 9);
  EXPECT_EQ(corrected.budget.smearing, 0.0);
  EXPECT_NEAR(corrected.nsr_exposure, 3.53e-3, 0.005e-3);
  std::printf("uncorrected %+.2f %%, NSR %.4e -> %.4e\n", 100.0 * share, without.nsr_exposure, corrected.nsr_exposure);
}

TEST(SmearingBudget, VarianceIsThatOfPixelsAndOfColumnsInCommon) {
  const test::GroundScene s = scene();
  GroundModel model = s.model();
  model.smearing.electrons = smeared(s, 41);
  model.smearing.overscan_rows = kOverscanRows;
  for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
    PhotometrySettings settings = fixed_mask();
    settings.background = background;
    const StarEstimator e = build(model, settings);
    // By hand, from the weights: pixel i of column c has S_c + ..., the level of the column (S_c + r²) / n.
    double pixels = 0.0;
    std::vector<double> columns(41, 0.0);
    for (const EstimatorTerm& term : e.terms) {
      const auto w = static_cast<double>(term.weight);
      pixels += w * w * model.smearing.electrons[term.pixel % 41];
      columns[term.pixel % 41] += w;
    }
    double levels = 0.0;
    for (std::size_t c = 0; c < columns.size(); ++c)
      levels += columns[c] * columns[c] * (model.smearing.electrons[c] + 50.2 * 50.2 + 7.2 * 7.2) / kOverscanRows;
    EXPECT_NEAR(e.budget.var_smearing, pixels, 1e-12 * pixels);
    EXPECT_NEAR(e.budget.var_smearing_correction, levels, 1e-12 * levels);
  }
}

TEST(SmearingBudget, AMeasuredBiasEntersWithAllWeightUnlessItCancels) {
  const test::GroundScene s = scene();
  GroundModel model = s.model();
  model.bias_variance = 4.0;
  PhotometrySettings settings = fixed_mask();
  EXPECT_DOUBLE_EQ(build(model, settings).budget.var_bias, 81.0 * 4.0);
  settings.background = BackgroundMethod::kLocal;
  EXPECT_NEAR(build(model, settings).budget.var_bias, 0.0, 1e-9);  // weights are floats: they sum to 1e-6
  settings.background = BackgroundMethod::kKnown;
  model.smearing.overscan_rows = kOverscanRows;
  EXPECT_EQ(build(model, settings).budget.var_bias, 0.0);
}

TEST(SmearingBudget, MaskKnowsTheNoiseOfWhatIsSmeared) {
  const test::GroundScene s = scene();
  GroundModel model = s.model();
  PhotometrySettings settings = fixed_mask();
  settings.mask_window = 6;
  ASSERT_EQ(build(model, settings).mask_pixels, 9);
  model.smearing.electrons = smeared(s, 41);
  for (double& column : model.smearing.electrons) column *= 10.0;
  const StarEstimator best = build(model, settings);
  const StarEstimator square = build(model, fixed_mask());
  ASSERT_EQ(square.mask_pixels, 9);
  EXPECT_NE(best.mask_pixels, 9);
  EXPECT_LT(best.nsr_exposure, square.nsr_exposure);
}

}  // namespace
}  // namespace astroid
