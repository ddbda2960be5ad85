// What jitter and unequal pixels add to the noise of an hour is what F25-F29 say.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

struct HourlyNoise {
  double measured = 0.0;  ///< relative variance of hourly means, mean over stars
  double jitter = 0.0;    ///< predicted part by jitter
  double prnu = 0.0;      ///< predicted part by jitter over unequal pixels
  double rest = 0.0;      ///< photon, sky and readout noise
};

/// Bright stars at many sub-pixel phases, so that motion shows; `seeds` independent runs of the same field.
HourlyNoise hourly_noise(bool prnu, JitterModel jitter, double rms_arcsec, int seeds) {
  HourlyNoise noise;
  constexpr int kStars = 144;
  for (int seed = 0; seed < seeds; ++seed) {
    Mission mission = test::bare_mission(512, 512);
    mission.simulation.seed = static_cast<std::uint64_t>(100 + seed);
    mission.simulation.exposures = 144 * 30;
    mission.ccd.window = 6;
    mission.ccd.prnu = prnu ? 0.01 : 0.0;
    mission.satellite.jitter.model = jitter;
    mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(rms_arcsec);
    mission.satellite.jitter.roll = Arcseconds(0.0);
    std::vector<test::LabStar> stars;
    for (int i = 0; i < kStars; ++i) {
      const int column = i % 12;
      const int row = i / 12;
      // Phases spread evenly over the pixel in both axes.
      stars.push_back(
          {20.0 + 40.0 * column + (column + 0.5) / 12.0 - 0.5, 20.0 + 40.0 * row + (row + 0.5) / 12.0 - 0.5, 1e8});
    }
    const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
    const auto plan = std::make_shared<const Plan>(make_plan(*scene));
    const Ground ground = perfect_ground(*scene);
    const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
    const StreamResult result = stream_exposures(
        scene, plan, estimators,
        {.threads = static_cast<int>(std::thread::hardware_concurrency()), .folder = {}, .progress = {}});
    const std::vector<StarMotion> motions = target_motions(*scene);
    const RunSetup setup = run_setup(mission);
    for (std::size_t t = 0; t < estimators.size(); ++t) {
      const double share = 1.0 / (kStars * seeds);
      const PredictedNoise predicted = predict_noise(estimators[t], motions[t], setup);
      const double sigma = result.series[t].bin_means.value;
      noise.measured += share * sigma * sigma;
      noise.jitter += share * 1e-12 * predicted.bin.jitter * predicted.bin.jitter;
      noise.prnu += share * 1e-12 * predicted.bin.prnu_jitter * predicted.bin.prnu_jitter;
      noise.rest += share * 1e-12 *
                    (predicted.bin.photon * predicted.bin.photon + predicted.bin.readout * predicted.bin.readout +
                     predicted.bin.background * predicted.bin.background +
                     predicted.bin.quantisation * predicted.bin.quantisation);
    }
  }
  return noise;
}

TEST(JitterNoise, OfAnHourIsThatOfTheOrnsteinUhlenbeckCovariance) {
  const HourlyNoise noise = hourly_noise(false, JitterModel::kRedNoise, 0.038, 6);
  const double excess = noise.measured - noise.rest;
  std::printf("hourly jitter noise %.3f ppm rms, predicted %.3f ppm; all other %.3f ppm\n", 1e6 * std::sqrt(excess),
              1e6 * std::sqrt(noise.jitter), 1e6 * std::sqrt(noise.rest));
  // All stars of a run share the motion: 6 runs x 30 hours x 2 axes of nearly independent means, and sample variance.
  const double relative_error = std::sqrt(2.0 / (6 * 29 * 2));
  EXPECT_NEAR(excess / noise.jitter, 1.0, 3.5 * relative_error);
  EXPECT_GT(noise.jitter, 4.0 * noise.rest);
}

TEST(JitterNoise, OverUnequalPixelsIsThatOfF27) {
  const HourlyNoise with = hourly_noise(true, JitterModel::kRedNoise, 0.038, 6);
  const HourlyNoise without = hourly_noise(false, JitterModel::kRedNoise, 0.038, 6);
  // The same attitude in both, so the common part of the jitter cancels.
  const double excess = with.measured - without.measured;
  std::printf("PRNU x jitter %.3f ppm rms, predicted %.3f ppm\n", 1e6 * std::sqrt(std::max(0.0, excess)),
              1e6 * std::sqrt(with.prnu));
  // The cross term of gradient and PRNU gradient does not vanish star by star: 144 stars average it down.
  const double cross = 2.0 * std::sqrt(with.jitter * with.prnu / (144.0 * 6));
  EXPECT_NEAR(excess, with.prnu, 3.5 * (cross + with.prnu * std::sqrt(2.0 / (6 * 29 * 2))));
  EXPECT_GT(excess, 0.0);
}

TEST(JitterNoise, IsAbsentWhenNothingMoves) {
  const HourlyNoise noise = hourly_noise(true, JitterModel::kNone, 0.038, 1);
  EXPECT_NEAR(noise.measured / noise.rest, 1.0, 4.0 * std::sqrt(2.0 / (144 * 29)));
}

}  // namespace
}  // namespace astroid
