// The mean light curve of cameras of different groups has the noise that is predicted: what is common stays, what each
// has of its own averages out.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "astroid/analysis/group_mean.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 400;
constexpr int kStars = 64;

/// Two groups, of which the second has another roll, sees less light and is half a cycle late.
Mission mission_of_two(int exposures) {
  Mission mission = test::bare_mission(kSide, kSide);
  mission.simulation.seed = 5;
  mission.simulation.exposures = exposures;
  mission.ccd.window = 6;
  mission.ccd.gain = Gain(100.0);
  mission.ccd.readout_noise = Electrons(50.0);
  mission.photometry.mask_window = 3;
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = Arcseconds(0.012);
  mission.satellite.jitter.pitch = Arcseconds(0.006);
  mission.satellite.jitter.timescale = Seconds(30.0);
  mission.analysis.bin = Seconds(200.0);
  mission.telescope.cameras = mission.telescope.simulated_cameras = 6;
  mission.telescope.groups.cameras = {4, 2};
  mission.telescope.groups.roll = {0.0, 90.0};
  mission.telescope.groups.stagger = {0.0, 12.5};
  mission.telescope.groups.throughput = {1.0, 0.6};
  return mission;
}

/// Stars of the sky on a grid, at phases that differ, seen by both groups.
StarCatalogue stars_of_grid(const Mission& mission) {
  StarCatalogue catalogue;
  catalogue.source = "grid";
  catalogue.passband = "P";
  catalogue.positions = PositionKind::kSky;
  catalogue.brightness = BrightnessKind::kElectrons;
  for (int i = 0; i < kStars; ++i) {
    constexpr int kAcross = 8;
    constexpr double kSpacing = 40.0;  // px
    const double x = kSpacing * (i % kAcross - 3.5) + 0.13 * (i % 7);
    const double y = kSpacing * (i / kAcross - 3.5) + 0.17 * (i % 5);
    CatalogueStar star;
    star.id = "star" + std::to_string(i);
    star.sky = inverse_gnomonic({x * 15.0 / 3600.0, y * 15.0 / 3600.0},
                                {mission.satellite.ra.value(), mission.satellite.dec.value()});
    star.electrons = 3e7;
    catalogue.stars.push_back(star);
  }
  return catalogue;
}

TEST(CameraGroups, HaveTheNoiseInTheirMeanThatIsPredicted) {
  constexpr int kExposures = 8 * 400;
  const Mission mission = mission_of_two(kExposures);
  const PreparedRun run = prepare_run(mission, stars_of_grid(mission));
  const GroundSegment ground = perfect_ground_segment(run);
  const StreamResult result =
      stream_exposures(stream_groups(run, ground), {.threads = 0, .folder = {}, .progress = {}});
  ASSERT_EQ(result.series.size(), static_cast<std::size_t>(kStars));
  const RunSetup setup = run_setup(mission);
  const AttitudeSharing attitude(run);
  double measured = 0.0;
  double predicted = 0.0;
  double common = 0.0;
  double if_alike = 0.0;
  for (std::size_t t = 0; t < result.series.size(); ++t) {
    const std::vector<GroupView> views{{&ground.estimators[0][t], run.groups[0].share},
                                       {&ground.estimators[1][t], run.groups[1].share}};
    const StarEstimator mean = mean_estimator(views);
    const PredictedNoise noise =
        predict_mean_noise(mean, mean_motion_noise(views, attitude.of_target(t), setup), setup);
    const double sigma = 1e6 * result.series[t].bin_means.value * c4(result.series[t].bins);
    measured += sigma * sigma / kStars;
    predicted += noise.bin_simulated * noise.bin_simulated / kStars;
    common += noise.bin_common * noise.bin_common / kStars;
    // As if the second group moved with the first: what the prediction would be without its own axes and time.
    const std::vector<CrossMotion> own = attitude.of_target(t);
    const double alone = motion_noise(ground.estimators[0][t],
                                      {.exposure = {}, .bin = {own[0].bin.xx, own[0].bin.xy, own[0].bin.yy}}, setup)
                             .jitter_bin;
    if_alike += 1e12 * alone / kStars;
  }
  std::printf(
      "noise of a bin of six cameras: measured %.2f ppm, predicted %.2f ppm, of that common %.2f ppm; jitter of "
      "the first group alone %.2f ppm\n",
      std::sqrt(measured), std::sqrt(predicted), std::sqrt(common), std::sqrt(if_alike));
  // 400 bins of two angles that all stars share, and each star's own photons.
  const double error = std::sqrt(2.0 / 400.0 / 2.0) * common + std::sqrt(2.0 / 400.0 / kStars) * (predicted - common);
  EXPECT_NEAR(measured, predicted, 3.5 * error);
  // Both parts count, and the groups do not move alike: else nothing would have been tested.
  EXPECT_GT(common, 0.3 * predicted);
  EXPECT_LT(common, 0.8 * predicted);
  EXPECT_LT(common, 0.9 * if_alike);
}

TEST(CameraGroups, AskForTheAttitudeAtTheSameInstants) {
  // The fainter group alone would do with fewer steps: then the two would see two paths.
  const Mission mission = mission_of_two(8);
  const PreparedRun run = prepare_run(mission, stars_of_grid(mission));
  const int own = make_plan(*run.groups[1].scene).knobs.attitude_steps;
  EXPECT_LT(own, make_plan(*run.groups[0].scene).knobs.attitude_steps);
  EXPECT_EQ(run.groups[0].plan->knobs.attitude_steps, run.groups[1].plan->knobs.attitude_steps);
}

TEST(CameraGroups, HaveTheSameFluxesForAnyNumberOfThreads) {
  const Mission mission = mission_of_two(40);
  const PreparedRun run = prepare_run(mission, stars_of_grid(mission));
  const GroundSegment ground = perfect_ground_segment(run);
  const auto series = [&](int threads, std::int64_t block) {
    return stream_exposures(stream_groups(run, ground),
                            {.threads = threads, .folder = {}, .progress = {}, .longest_block = block})
        .series;
  };
  const auto one = series(1, 1024);
  const auto three = series(3, 16);
  for (std::size_t t = 0; t < one.size(); ++t) {
    EXPECT_EQ(one[t].mean, three[t].mean) << t;
    EXPECT_EQ(one[t].exposure.value, three[t].exposure.value) << t;
  }
}

TEST(CameraGroups, OfAllCamerasMeasureWhatAMissionWithoutGroupsMeasures) {
  Mission without = mission_of_two(20);
  without.telescope.groups = {};
  Mission with = without;
  with.telescope.groups.cameras = {6};
  with.telescope.groups.tilt = with.telescope.groups.stagger = {0.0};
  const auto measure = [&](const Mission& mission) {
    const PreparedRun run = prepare_run(mission, stars_of_grid(mission));
    const GroundSegment ground = perfect_ground_segment(run);
    return stream_exposures(stream_groups(run, ground), {.threads = 2, .folder = {}, .progress = {}});
  };
  const StreamResult a = measure(without);
  const StreamResult b = measure(with);
  EXPECT_EQ(a.reference, b.reference);
  for (std::size_t t = 0; t < a.series.size(); ++t) {
    EXPECT_EQ(a.series[t].mean, b.series[t].mean) << t;
    EXPECT_EQ(a.series[t].bin_within.value, b.series[t].bin_within.value) << t;
  }
}

}  // namespace
}  // namespace astroid
