// Jitter correction leaves what the error of the attitude and the second order leave (F131, F155).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/analysis/group_mean.hpp"
#include "astroid/analysis/target_metrics.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kPerSide = 8;
constexpr int kStars = kPerSide * kPerSide;
constexpr std::int64_t kExposures = 1440;

/// Stars of one brightness in masks of 3 x 3 px, spread over the phases of a pixel; 15 arcsec/px.
Mission jittering_mission(JitterCorrection correction) {
  Mission mission = test::bare_mission(360, 360);
  mission.simulation.exposures = kExposures;
  mission.ccd.window = 6;
  mission.photometry.mask_window = 3;
  mission.ccd.gain = Gain(100.0);
  mission.ccd.readout_noise = Electrons(10.0);
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(0.038);
  mission.photometry.jitter_correction = correction;
  return mission;
}

StarCatalogue spread_stars(double electrons) {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < kStars; ++i) {
    const int column = i % kPerSide;
    const int row = i / kPerSide;
    const double dx = (column + 0.5) / kPerSide - 0.5;
    const double dy = (row + 0.5) / kPerSide - 0.5;
    stars.push_back({20.0 + 42.0 * column + dx, 20.0 + 42.0 * row + dy, electrons});
  }
  return test::lab_catalogue(stars);
}

/// Relative variances of one exposure, means over the stars.
struct Variances {
  double before = 0.0;            ///< measured
  double after = 0.0;             ///< measured, after correction
  double predicted_before = 0.0;  ///< without correction
  double predicted_after = 0.0;   ///< with it
  double own = 0.0;               ///< predicted of photons and readout
};

Variances exposure_variances(const Mission& mission, double electrons) {
  const PreparedRun run = prepare_run(mission, spread_stars(electrons));
  const GroundSegment ground = perfect_ground_segment(run);
  const StreamResult result =
      stream_exposures(stream_groups(run, ground), {.threads = 0, .folder = {}, .progress = {}});
  EXPECT_EQ(result.measured.size(), static_cast<std::size_t>(kStars));
  const RunSetup setup = run_setup(mission);
  const AttitudeSharing attitude(run);
  const bool own = ground.corrections.front().front().correction->is_measured();
  Variances mean;
  const auto square = [](double v) { return v * v; };
  for (std::size_t t = 0; t < result.series.size(); ++t) {
    const std::vector<GroupView> views{{&ground.estimators.front()[t], 1.0}};
    const MotionNoise moving = mean_motion_noise(views, attitude.of_target(t), setup);
    const MotionNoise error = mean_motion_noise(views, attitude_error_motion(run, ground.corrections, t), setup);
    const MotionNoise left = after_correction(moving, error, own, setup.exposures_per_bin);
    const StarEstimator& estimator = ground.estimators.front()[t];
    mean.before += square(result.measured[t].exposure.value) / kStars;
    mean.after += square(result.series[t].exposure.value) / kStars;
    mean.predicted_before += square(predict_mean_noise(estimator, moving, setup).exposure) / kStars;
    mean.predicted_after += square(predict_mean_noise(estimator, left, setup).exposure) / kStars;
    mean.own += square(predict_mean_noise(estimator, {}, setup).exposure) / kStars;
  }
  std::printf("noise of an exposure %.2f ppm (predicted %.2f), after correction %.3f ppm (predicted %.3f; own %.3f)\n",
              1e6 * std::sqrt(mean.before), 1e6 * std::sqrt(mean.predicted_before), 1e6 * std::sqrt(mean.after),
              1e6 * std::sqrt(mean.predicted_after), 1e6 * std::sqrt(mean.own));
  return mean;
}

TEST(JitterCorrection, WithTheTrueAttitudeLeavesTheNoiseOfThePhotons) {
  const Variances noise = exposure_variances(jittering_mission(JitterCorrection::kKnown), 1e8);
  // An Ornstein-Uhlenbeck path of 36,000 s with a time scale of 250 s has 72 independent values of each axis.
  EXPECT_NEAR(noise.before / noise.predicted_before, 1.0, 4.0 * std::sqrt(2.0 / (2 * 72)));
  EXPECT_GT(noise.before, 9.0 * noise.own);
  EXPECT_DOUBLE_EQ(noise.predicted_after, noise.own);
  EXPECT_NEAR(noise.after / noise.own, 1.0, 4.0 * std::sqrt(2.0 / (kStars * kExposures)));
}

TEST(JitterCorrection, LeavesTheSecondOrderOfTheMotion) {
  // A remainder of second order grows as the fourth power of the motion in variance: 16 times where it doubles.
  const auto remainder = [](double arcsec) {
    Mission mission = jittering_mission(JitterCorrection::kKnown);
    mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(arcsec);
    const Variances noise = exposure_variances(mission, 1e9);
    EXPECT_LT(noise.after, 0.02 * noise.before);
    return noise.after - noise.own;
  };
  const double ratio = remainder(0.76) / remainder(0.38);
  std::printf("remainder of twice the motion: %.2f times\n", ratio);
  // The next order has the share of the motion in the width of the PSF squared: (0.05 / 0.6)².
  EXPECT_NEAR(ratio, 16.0, 16.0 * 4.0 * 0.05 * 0.05 / (0.6 * 0.6));
}

TEST(JitterCorrection, WithAWrongAttitudeLeavesItsError) {
  Mission mission = jittering_mission(JitterCorrection::kKnown);
  mission.photometry.knowledge.attitude = Arcseconds(0.019);
  const Variances noise = exposure_variances(mission, 1e9);
  EXPECT_GT(noise.predicted_after, 9.0 * noise.own);
  // The error is the same for all stars, new in each exposure, about two axes.
  EXPECT_NEAR(noise.after / noise.predicted_after, 1.0, 4.0 * std::sqrt(2.0 / (2.0 * kExposures)));
  EXPECT_LT(noise.predicted_after, 0.3 * noise.predicted_before);
}

TEST(JitterCorrection, ByCentroidsLeavesWhatItPredicts) {
  const Variances noise = exposure_variances(jittering_mission(JitterCorrection::kCentroids), 1e8);
  EXPECT_GT(noise.before, 9.0 * noise.own);
  EXPECT_GT(noise.predicted_after, noise.own);
  // The stars that show the attitude are those that it is taken out of: to the share 1 / kStars of its error their
  // own noise is in it.
  const double error = noise.predicted_after - noise.own;
  EXPECT_NEAR(noise.after, noise.predicted_after,
              4.0 * noise.own * std::sqrt(2.0 / (kStars * kExposures)) + 4.0 * error);
}

TEST(JitterCorrection, MeasuresTheAttitudeAsWellAsItSays) {
  const test::TemporaryFolder folder;
  Mission mission = jittering_mission(JitterCorrection::kCentroids);
  mission.output.light_curves = LightCurveOutput::kTargets;
  const PreparedRun run = prepare_run(mission, spread_stars(1e5));
  const GroundSegment ground = perfect_ground_segment(run);
  (void)stream_exposures(stream_groups(run, ground), {.threads = 0, .folder = folder.path(), .progress = {}});
  const LightCurveReader reader((folder.path() / "photometry/lightcurves.fits").string());
  const std::vector<Attitude> measured = reader.attitudes(1);
  const std::shared_ptr<const AttitudeSeries> truth = make_attitude_series(run.scene(), *run.groups.front().plan);
  ASSERT_EQ(measured.size(), static_cast<std::size_t>(kExposures));
  const AttitudeCovariance& error = ground.corrections.front().front().correction->error();
  double yaw = 0.0;
  double pitch = 0.0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    yaw += std::pow(measured[k].yaw - truth->moments[k].mean.yaw, 2) / error.yaw_yaw / kExposures;
    pitch += std::pow(measured[k].pitch - truth->moments[k].mean.pitch, 2) / error.pitch_pitch / kExposures;
  }
  std::printf("attitude %.4f arcsec off; variance over the predicted %.3f and %.3f\n", std::sqrt(error.yaw_yaw), yaw,
              pitch);
  const double tolerance = 4.0 * std::sqrt(2.0 / kExposures);
  EXPECT_NEAR(yaw, 1.0, tolerance);
  EXPECT_NEAR(pitch, 1.0, tolerance);
}

TEST(JitterCorrection, TellsTheAttitudeAndTheResponseByWhichAReaderUndoesIt) {
  const test::TemporaryFolder folder;
  const auto light_curves = [&](const char* name, JitterCorrection correction) {
    Mission mission = jittering_mission(correction);
    mission.simulation.exposures = 20;
    mission.output.light_curves = LightCurveOutput::kTargets;
    const PreparedRun run = prepare_run(mission, spread_stars(1e6));
    const GroundSegment ground = perfect_ground_segment(run);
    (void)stream_exposures(stream_groups(run, ground), {.threads = 1, .folder = folder.path() / name, .progress = {}});
    return LightCurveReader((folder.path() / name / "photometry/lightcurves.fits").string());
  };
  const LightCurveReader raw = light_curves("raw", JitterCorrection::kNone);
  const LightCurveReader corrected = light_curves("corrected", JitterCorrection::kKnown);
  EXPECT_TRUE(raw.attitudes(1).empty());
  const std::vector<Attitude> attitudes = corrected.attitudes(1);
  ASSERT_EQ(attitudes.size(), 20U);
  for (std::size_t star = 0; star < kStars; ++star) {
    const LightCurve before = raw.read(star, 1);
    const LightCurve after = corrected.read(star, 1);
    ASSERT_EQ(before.star.reference, after.star.reference) << "every mask is the whole window";
    for (std::size_t k = 0; k < attitudes.size(); ++k) {
      const double deviation = after.flux[k] / after.star.reference - 1.0;
      EXPECT_NEAR(with_attitude(deviation, after.star.response, attitudes[k]),
                  before.flux[k] / before.star.reference - 1.0, 2e-7);  // fluxes have single precision
    }
  }
}

}  // namespace
}  // namespace astroid
