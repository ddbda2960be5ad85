// A bright star in the column of a target: what it smears into the target's flux, and what calibration leaves of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kPairs = 8;
constexpr std::int64_t kExposures = 1000;
constexpr int kBinExposures = 100;

double electrons(double magnitude) {
  return 21.0 * std::pow(10.0, -0.4 * (magnitude - 20.62));
}

/// PLATO's detector: targets of P = 11 at the centres of pixels, each with a star of P = 2 a thousand rows away in its
/// column. What lies in every pixel, 945 e-, is known.
Mission bright_neighbours() {
  Mission mission = test::bare_mission(4510, 4510);
  mission.simulation.exposures = kExposures;
  mission.analysis.bin = Seconds(25.0 * kBinExposures);
  mission.ccd.window = 6;
  mission.ccd.dark_current = ElectronsPerSecond(45.0);
  mission.ccd.readout_noise = Electrons(50.2);
  mission.ccd.gain = Gain(7.2 * std::sqrt(12.0));
  mission.ccd.bias = Adu(1000.0);
  mission.ccd.reference = {.prescan = 25, .serial_overscan = 25, .parallel_overscan = 30};
  mission.photometry.mask_window = 3;  // a mask of 3 x 3 px, whatever the noise
  return mission;
}

void smear(Mission& mission) {
  mission.ccd.smearing = {.model = SmearingModel::kOpenShutter, .time = Seconds(4.019), .clear_time = Seconds(4.019)};
}

/// Means over the targets of P = 11.
struct Measured {
  double flux = 0.0;  ///< measured / light of the stars in the mask
  double flux_error = 0.0;
  double expected = 0.0;  ///< the same as the ground expects it
  double nsr = 0.0;       ///< of one exposure, relative to the target's flux
  double predicted = 0.0;
  double smearing_mag = 0.0;
  double residual_mag = 0.0;
  [[nodiscard]] double z_flux() const { return (flux - expected) / flux_error; }
  [[nodiscard]] double z_nsr() const {
    return (nsr / predicted - 1.0) * std::sqrt(2.0 * static_cast<double>(kPairs * kExposures));
  }
};

Measured measure(const Mission& mission) {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < kPairs; ++i) {
    stars.push_back({500.0 + 450.0 * i, 1000.0 + 100.0 * i, electrons(11.0)});
    stars.push_back({500.0 + 450.0 * i, 2000.0 + 100.0 * i, electrons(2.0)});
  }
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  EXPECT_EQ(plan->runs("open-shutter-smearing"), mission.ccd.smearing.model == SmearingModel::kOpenShutter);
  const Ground ground = perfect_ground(*scene);
  const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
  const StreamResult result = stream_exposures(scene, plan, estimators, {.threads = 0, .folder = {}, .progress = {}});
  const RunSetup setup = run_setup(mission);
  const std::vector<StarMotion> motions = target_motions(*scene);
  Measured mean;
  for (std::size_t t = 0; t < estimators.size(); t += 2) {
    EXPECT_EQ(estimators[t].mask_pixels, 9);
    const SceneStar& star = scene->stars()[scene->targets()[t]];
    TargetMetrics target = predict_target({.id = star.id,
                                           .magnitude = star.magnitude.value(),
                                           .x = star.position.x,
                                           .y = star.position.y,
                                           .electrons = star.electrons},
                                          estimators[t], motions[t], setup);
    add_measurement(target, result.series[t], result.reference[t], 0, setup);
    const double stars_alone = target.flux_expected - target.flux_smeared;
    mean.flux += target.flux_measured / stars_alone / kPairs;
    mean.expected += target.flux_expected / stars_alone / kPairs;
    mean.flux_error += target.flux_err * target.flux_err / (stars_alone * stars_alone);
    mean.nsr += target.nsr_exposure_measured.value / kPairs;
    mean.predicted += target.predicted.exposure / kPairs;
    mean.smearing_mag += target.causes.smearing / kPairs;
    mean.residual_mag += target.causes.residual / kPairs;
  }
  mean.flux_error = std::sqrt(mean.flux_error) / kPairs;
  return mean;
}

void print(const char* what, const Measured& m) {
  std::printf("%-40s flux %+.3f %% (expected %+.3f %%, z %+.2f), NSR %.4e (predicted %.4e, z %+.2f)\n", what,
              100.0 * (m.flux - 1.0), 100.0 * (m.expected - 1.0), m.z_flux(), m.nsr, m.predicted, m.z_nsr());
}

void expect_as_predicted(const Measured& m) {
  EXPECT_LT(std::fabs(m.z_flux()), 4.0);
  EXPECT_LT(std::fabs(m.z_nsr()), 4.0);
  EXPECT_NEAR(m.residual_mag, 0.0, 4.0 * 1.0857 * m.flux_error);
}

TEST(Smearing, OfABrightStarIsHalfAMagnitudeUnlessItIsCorrected) {
  Mission mission = bright_neighbours();
  const Measured sharp = measure(mission);
  print("with a shutter", sharp);
  expect_as_predicted(sharp);
  EXPECT_NEAR(sharp.predicted, 2.907e-3, 0.001e-3);
  EXPECT_EQ(sharp.expected, 1.0);

  smear(mission);
  const Measured smeared = measure(mission);
  print("smeared", smeared);
  expect_as_predicted(smeared);
  EXPECT_NEAR(smeared.flux - 1.0, 0.513, 0.001);
  EXPECT_NEAR(smeared.smearing_mag, -0.450, 0.001);

  mission.photometry.calibration.smearing = true;
  const Measured corrected = measure(mission);
  print("corrected with 30 overscan rows", corrected);
  expect_as_predicted(corrected);
  EXPECT_EQ(corrected.expected, 1.0);
  EXPECT_EQ(corrected.smearing_mag, 0.0);
  EXPECT_NEAR(corrected.predicted, 3.53e-3, 0.005e-3);
  EXPECT_NEAR(corrected.nsr, 3.53e-3, 4.0 * 3.53e-3 / std::sqrt(2.0 * kPairs * kExposures));
}

TEST(Smearing, OfTheSkyIsCorrectedToo) {
  Mission mission = bright_neighbours();
  smear(mission);
  mission.field.sky_background = ElectronsPerSecond(45.0);  // 181 e- smeared into each pixel
  mission.ccd.dark_current = ElectronsPerSecond(0.0);
  mission.photometry.calibration.smearing = true;
  const Measured corrected = measure(mission);
  print("with a sky of 45 e-/px/s", corrected);
  expect_as_predicted(corrected);
  EXPECT_EQ(corrected.expected, 1.0);
}

TEST(Smearing, IsCorrectedWithALocalBackground) {
  Mission mission = bright_neighbours();
  smear(mission);
  mission.ccd.window = 20;
  mission.photometry.background = BackgroundMethod::kLocal;
  const Measured smeared = measure(mission);
  print("smeared, local background", smeared);
  expect_as_predicted(smeared);
  mission.photometry.calibration.smearing = true;
  const Measured corrected = measure(mission);
  print("corrected, local background", corrected);
  expect_as_predicted(corrected);
  EXPECT_NEAR(corrected.expected, 1.0, 1e-12);
}

TEST(Smearing, OfFourNodesIsThatOfEachHalf) {
  Mission mission = bright_neighbours();
  smear(mission);
  mission.ccd.nodes.count = 4;
  // Half of the bright stars lie beyond the middle, at rows above 2255, and smear into the other half of the column.
  const Measured smeared = measure(mission);
  print("smeared, four nodes", smeared);
  expect_as_predicted(smeared);
  mission.photometry.calibration.smearing = true;
  const Measured corrected = measure(mission);
  print("corrected, four nodes", corrected);
  expect_as_predicted(corrected);
  EXPECT_EQ(corrected.expected, 1.0);
}

TEST(Bias, ThatDriftsIsMeasuredInThePrescan) {
  Mission mission = bright_neighbours();
  mission.ccd.electronics.bias_drift = 5.0;
  mission.ccd.electronics.drift_period = Seconds(25.0 * 250.0);
  const Measured known = measure(mission);
  print("bias drifts by 5 ADU, believed constant", known);
  // 9 px x 5 ADU: 1122 e- of amplitude, over four whole periods.
  const double amplitude = 9.0 * 5.0 * mission.ccd.gain.value();
  EXPECT_GT(known.nsr * electrons(11.0), 0.6 * amplitude);
  EXPECT_NEAR(known.nsr / known.predicted, 1.0, 0.02);

  mission.photometry.calibration.bias = BiasSource::kPrescan;
  const Measured measured = measure(mission);
  print("bias drifts by 5 ADU, prescan", measured);
  expect_as_predicted(measured);
  EXPECT_LT(measured.predicted, 2.95e-3);
}

TEST(NonLinearity, IsUndoneByItsInverseAndBiasesOtherwise) {
  Mission mission = bright_neighbours();
  mission.ccd.electronics.nonlinearity = {0.0, -0.0042789409, 2.365e-7};
  const Measured bent = measure(mission);
  print("electronics bend the signal", bent);
  // Most of the pixels' signal is faint: what the linear coefficient takes away is not given back.
  EXPECT_NEAR(bent.flux - 1.0, -0.0043, 0.001);

  mission.photometry.calibration.nonlinearity = true;
  const Measured straight = measure(mission);
  print("straightened", straight);
  EXPECT_LT(std::fabs(straight.z_flux()), 4.0);

  mission.photometry.calibration.nonlinearity_coefficients = {0.0, -0.0032789409, 2.365e-7};
  const Measured wrong = measure(mission);
  print("straightened with a1 wrong by 1e-3", wrong);
  EXPECT_NEAR(wrong.flux - 1.0, -0.001, 0.0003);
}

TEST(Nodes, HaveTheirOwnGainAndNoise) {
  Mission mission = bright_neighbours();
  mission.ccd.nodes.count = 2;
  mission.ccd.nodes.gain_factor = {1.0, 1.15};
  mission.ccd.nodes.noise_factor = {1.0, 1.4};
  const Measured both = measure(mission);
  print("two nodes, gain and noise known", both);
  expect_as_predicted(both);
  mission.photometry.calibration.gain = false;
  const Measured one_gain = measure(mission);
  print("two nodes, one gain", one_gain);
  // Half of the targets are read with 1.15 times the gain that the ground believes.
  EXPECT_NEAR(one_gain.flux, 0.5 + 0.5 / 1.15, 0.02);
}

TEST(PickUp, AddsTheNoiseOfAWave) {
  Mission mission = bright_neighbours();
  mission.ccd.electronics.pick_up = {.amplitude = 4.0, .column_frequency = 0.13, .row_frequency = -0.07};
  const Measured m = measure(mission);
  print("a wave of 4 ADU", m);
  expect_as_predicted(m);
}

TEST(RowOffsets, AddTheNoiseOfRowsInCommon) {
  Mission mission = bright_neighbours();
  mission.ccd.electronics.row_offset = 2.0;
  const Measured m = measure(mission);
  print("rows offset by 2 ADU rms", m);
  expect_as_predicted(m);
  EXPECT_GT(m.predicted, 3.2e-3);
}

}  // namespace
}  // namespace astroid
