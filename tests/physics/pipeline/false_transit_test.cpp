// An eclipse of a contaminant in the light curve of its neighbour: as deep as the stellar pollution ratio says.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "astroid/pipeline/ground.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

/// What an estimator makes of expected electrons: its flux without any noise.
double noiseless_flux(const StarEstimator& estimator, const ExposureState& state) {
  const auto pixels = std::as_const(state.expected).whole().pixels();
  double flux = -estimator.offset;
  for (const EstimatorTerm& term : estimator.terms) flux += static_cast<double>(term.weight) * pixels[term.pixel];
  return flux;
}

TEST(FalseTransit, OfAnEclipsingNeighbourHasTheDepthOfThePollutionRatio) {
  const test::TemporaryFolder folder;
  Mission mission = test::bare_mission(24, 24);
  mission.simulation.exposures = 144;
  mission.telescope.cameras = 24;
  mission.field.sky_background = ElectronsPerSecond(45.0);
  mission.psf.sigma = Pixels(0.6);
  mission.ccd.readout_noise = Electrons(50.2);
  mission.ccd.gain = Gain(7.2 * std::sqrt(12.0));
  mission.photometry.method = PhotometryMethod::kMask;
  mission.photometry.mask_window = 6;
  mission.field.variables = folder
                                .write("variables.csv",
                                       "id,kind,period_d,depth_ppm,duration_h,ingress_h,epoch_d,secondary_ppm\n"
                                       "star2,eclipse,1.0,500000,0.3,0.01,0.02,0\n")
                                .string();
  constexpr double kElectrons = 147985.98;  // P = 11, in the middle of the pixel
  const auto scene =
      std::make_shared<const Scene>(mission, test::lab_catalogue({{12.0, 12.0, kElectrons}, {13.0, 12.0, kElectrons}}));
  const Ground ground = perfect_ground(*scene);
  const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
  const StarEstimator& target = estimators.front();
  EXPECT_EQ(target.mask_pixels, 7);
  EXPECT_NEAR(target.spr_total, 0.38153972, 1e-7);
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ExposureState state = simulator.make_state();
  double most = 0.0;
  double least = 1e300;
  for (std::int64_t k = 0; k < mission.simulation.exposures; ++k) {
    simulator.expect(k, state);
    most = std::max(most, noiseless_flux(target, state));
    least = std::min(least, noiseless_flux(target, state));
  }
  const double depth = 1e6 * (1.0 - least / most);
  std::printf("an eclipse of 50 %% shows as %.2f ppm\n", depth);
  EXPECT_NEAR(depth, 190770.0, 1.0);
}

}  // namespace
}  // namespace astroid
