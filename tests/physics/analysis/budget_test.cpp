// The analytic budget against the published masks and contamination of a Gaussian star.
#include "astroid/analysis/budget.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "astroid/core/photometric.hpp"

namespace astroid {
namespace {

/// A camera with a known sky of 945 e-/px and quantisation noise of exactly 7.2 e-.
Mission mask_mission() {
  Mission mission;
  mission.simulation.cycle = Seconds(25.0);
  mission.simulation.exposure_time = Seconds(21.0);
  mission.telescope.zero_point = Magnitude(20.62);
  mission.telescope.cameras = 24;
  mission.field.sky_background = ElectronsPerSecond(45.0);
  mission.ccd.readout_noise = Electrons(50.2);
  mission.ccd.gain = Gain(7.2 * std::sqrt(12.0));
  mission.ccd.bias = Adu(1000.0);
  mission.photometry.method = PhotometryMethod::kMask;
  mission.photometry.mask_window = 6;
  mission.photometry.background = BackgroundMethod::kKnown;
  mission.analysis.bin = Seconds(3600.0);
  return mission;
}

struct Published {
  double mag, electrons;
  int pixels;
  double fraction, nsr, hour_24, hour_6;
};
constexpr std::array<Published, 3> kPublished{{{10.0, 371722.881, 9, 0.975316, 1.731782e-3, 29.4582, 58.9164},
                                               {11.0, 147985.544, 9, 0.975316, 2.906516e-3, 49.4408, 98.8817},
                                               {12.0, 58914.106, 9, 0.975316, 5.195210e-3, 88.3723, 176.7446}}};

TEST(AnalyticBudget, ReproducesTheTableOfOptimalMasks) {
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> magnitudes{10.0, 11.0, 12.0};
  Mission mission = mask_mission();
  const auto all = analytic_budget(mission, *psf, magnitudes);
  mission.telescope.cameras = 6;
  const auto six = analytic_budget(mission, *psf, magnitudes);
  for (std::size_t i = 0; i < kPublished.size(); ++i) {
    const Published& p = kPublished[i];
    EXPECT_NEAR(all[i].electrons, p.electrons, 6e-4);
    EXPECT_EQ(all[i].mask_pixels, p.pixels);
    EXPECT_NEAR(all[i].enclosed_fraction, p.fraction, 6e-7);
    EXPECT_NEAR(all[i].nsr_exposure / p.nsr, 1.0, 1e-6);
    EXPECT_NEAR(all[i].nsr_1h_ppm / p.hour_24, 1.0, 2e-6);
    EXPECT_NEAR(six[i].nsr_1h_ppm / p.hour_6, 1.0, 2e-6);
  }
}

TEST(AnalyticBudget, ReachesAnEarthAtThePublishedMagnitude) {
  // 84 ppm, 13 h, 3 transits at 7.1 sigma allow 73.884 ppm in an hour: crossed at P = 11.707.
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> magnitudes{11.706, 11.708};
  const auto rows = analytic_budget(mask_mission(), *psf, magnitudes);
  const double allowed = 84.0 * std::sqrt(39.0) / 7.1;
  EXPECT_LT(rows[0].nsr_1h_ppm, allowed);
  EXPECT_GT(rows[1].nsr_1h_ppm, allowed);
}

TEST(AnalyticBudget, AddsItsCausesInQuadrature) {
  Mission mission = mask_mission();
  mission.ccd.prnu = 0.01;
  mission.satellite.jitter = {JitterModel::kRedNoise, Arcseconds(0.038), Arcseconds(0.038),
                              Arcseconds(0.040),      Seconds(250.0),    ""};
  mission.photometry.background = BackgroundMethod::kLocal;
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> magnitudes{8.0, 11.0, 14.0};
  for (const BudgetRow& row : analytic_budget(mission, *psf, magnitudes)) {
    EXPECT_NEAR(row.causes.total(), row.nsr_1h_ppm, 1e-9 * row.nsr_1h_ppm);
    EXPECT_GT(row.causes.background_estimate, 0.0);
    EXPECT_GT(row.causes.prnu_jitter, 0.0);
    EXPECT_EQ(row.causes.contaminants, 0.0);
    EXPECT_NEAR(row.causes.photon, 1e6 / std::sqrt(row.electrons * row.enclosed_fraction * 144.0 * 24.0), 1e-6);
  }
}

TEST(AnalyticBudget, GivesThePublishedNoiseOfPixelGainsUnderJitter) {
  // 1 % along both axes at the pixel's centre is 14.7 ppm per sample of 0.0025333 px, for the whole PSF.
  Mission mission = mask_mission();
  mission.ccd.prnu = 0.01;
  mission.telescope.cameras = 1;
  mission.simulation.exposure_time = mission.simulation.cycle = mission.analysis.bin = Seconds(1e-9);
  mission.satellite.jitter = {JitterModel::kRedNoise, Arcseconds(0.038), Arcseconds(0.038),
                              Arcseconds(0.0),        Seconds(250.0),    ""};
  mission.photometry.method = PhotometryMethod::kAperture;
  mission.photometry.aperture_radius = Pixels(8.0);
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> magnitudes{11.0};
  EXPECT_NEAR(analytic_budget(mission, *psf, magnitudes)[0].causes.prnu_jitter, 14.7, 0.05);
}

TEST(AnalyticBudget, KnowsWhenTheBrightestPixelIsFull) {
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> magnitudes{6.0, 12.0};
  const auto rows = analytic_budget(mask_mission(), *psf, magnitudes);
  EXPECT_TRUE(rows[0].saturated);
  EXPECT_FALSE(rows[1].saturated);
}

StarEstimator with_neighbour(double dx, double fainter) {
  const Mission mission = mask_mission();
  const auto psf = make_gaussian_psf(0.6);
  const auto electrons = [&mission](double magnitude) {
    return (electron_rate(Magnitude(magnitude), mission.telescope.zero_point) * mission.simulation.exposure_time)
        .value();
  };
  const std::array<FieldStar, 2> stars{FieldStar{"T", {2.0, 2.0}, electrons(11.0)},
                                       FieldStar{"C", {2.0 + dx, 2.0}, electrons(11.0 + fainter)}};
  return estimator_of_first(mission, *psf, stars);
}

TEST(AnalyticBudget, OfAStarWithANeighbourIsThePublishedOne) {
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> magnitude{11.0};
  const std::vector<BudgetNeighbour> equal{{.dx = 1.0, .dy = 0.0, .fainter = DeltaMag(0.0)}};
  const BudgetRow row = analytic_budget(mask_mission(), *psf, magnitude, equal).front();
  EXPECT_EQ(row.mask_pixels, 7);
  EXPECT_NEAR(row.spr_tot, 0.38153972, 1e-7);
  EXPECT_NEAR(row.nsr_1h_ppm / 62.6266, 1.0, 1e-6);
  const std::vector<BudgetNeighbour> fainter{{.dx = 2.0, .dy = 0.0, .fainter = DeltaMag(2.0)}};
  const BudgetRow far = analytic_budget(mask_mission(), *psf, magnitude, fainter).front();
  EXPECT_EQ(far.mask_pixels, 9);
  EXPECT_NEAR(far.spr_tot, 0.03144899, 1e-7);
  EXPECT_NEAR(far.nsr_1h_ppm / 50.0948, 1.0, 1e-6);
}

TEST(Contamination, OfTwoStarsIsThePublishedOne) {
  const StarEstimator equal = with_neighbour(1.0, 0.0);
  EXPECT_EQ(equal.mask_pixels, 7);
  EXPECT_NEAR(equal.spr_total, 0.38153972, 1e-7);
  EXPECT_NEAR(equal.budget.contaminants / equal.budget.target, 0.61691872, 1e-7);
  EXPECT_NEAR(predict_noise(equal, {}, run_setup(mask_mission())).bin.total(), 62.6266, 1e-4);
  const StarEstimator fainter = with_neighbour(2.0, 2.0);
  EXPECT_EQ(fainter.mask_pixels, 9);
  EXPECT_NEAR(fainter.spr_total, 0.03144899, 1e-7);
  EXPECT_NEAR(fainter.budget.contaminants / fainter.budget.target, 0.03247014, 1e-7);
  EXPECT_NEAR(predict_noise(fainter, {}, run_setup(mask_mission())).bin.total(), 50.0948, 1e-4);
}

TEST(Contamination, FallsWithDistanceAndFaintness) {
  EXPECT_GT(with_neighbour(1.5, 1.0).spr_total, with_neighbour(2.5, 1.0).spr_total);
  EXPECT_GT(with_neighbour(1.5, 1.0).spr_total, with_neighbour(1.5, 2.0).spr_total);
  EXPECT_GT(with_neighbour(2.5, 3.0).spr_total, 0.0);
}

}  // namespace
}  // namespace astroid
