// What jitter and unequal pixels add to the noise of an hour is what F25-F29 say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "astroid/analysis/target_metrics.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr std::int64_t kPerHour = 144;

struct HourlyNoise {
  double measured = 0.0;  ///< relative variance of hourly means, mean over stars
  double jitter = 0.0;    ///< predicted part by jitter
  double prnu = 0.0;      ///< predicted part by jitter over unequal pixels
  double rest = 0.0;      ///< photon, sky and readout noise
  double realised = 0.0;  ///< variance of the attitude's hourly means over that of the Ornstein-Uhlenbeck law
};

/// Covariance of the hourly means that the attitude of a run really has.
AttitudeCovariance hourly_covariance(const AttitudeSeries& series) {
  std::vector<Attitude> hours;
  for (std::size_t first = 0; first + kPerHour <= series.moments.size(); first += kPerHour) {
    Attitude mean;
    for (std::size_t k = first; k < first + kPerHour; ++k) {
      mean.yaw += series.moments[k].mean.yaw / kPerHour;
      mean.pitch += series.moments[k].mean.pitch / kPerHour;
    }
    hours.push_back(mean);
  }
  AttitudeCovariance covariance = attitude_moments(hours).covariance;
  const double unbiased = static_cast<double>(hours.size()) / static_cast<double>(hours.size() - 1);
  covariance.yaw_yaw *= unbiased;
  covariance.yaw_pitch *= unbiased;
  covariance.pitch_pitch *= unbiased;
  return covariance;
}

enum class Phases { kCentred, kSpread };

/// Bright stars in a mask of 3 x 3 px, at the centre of a pixel or at phases spread over it; `seeds` runs of 30 hours.
/// The motion is predicted from the attitude that each run had, so only the photons are left to chance.
HourlyNoise hourly_noise(Phases phases, double prnu, JitterModel jitter, int seeds) {
  HourlyNoise noise;
  constexpr int kStars = 144;
  for (int seed = 0; seed < seeds; ++seed) {
    Mission mission = test::bare_mission(512, 512);
    mission.simulation.seed = static_cast<std::uint64_t>(100 + seed);
    mission.simulation.exposures = kPerHour * 30;
    mission.ccd.window = 6;
    mission.photometry.mask_window = 3;  // a mask of 3 x 3 px, whatever the noise
    mission.ccd.gain = Gain(100.0);      // so that 1e9 electrons fit into 24 bits
    mission.ccd.prnu = prnu;
    mission.satellite.jitter.model = jitter;
    mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(0.038);
    std::vector<test::LabStar> stars;
    for (int i = 0; i < kStars; ++i) {
      const int column = i % 12;
      const int row = i / 12;
      const double dx = phases == Phases::kCentred ? 0.0 : (column + 0.5) / 12.0 - 0.5;
      const double dy = phases == Phases::kCentred ? 0.0 : (row + 0.5) / 12.0 - 0.5;
      stars.push_back({20.0 + 40.0 * column + dx, 20.0 + 40.0 * row + dy, 1e9});
    }
    const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
    const auto plan = std::make_shared<const Plan>(make_plan(*scene));
    const Ground ground = perfect_ground(*scene);
    const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
    const StreamResult result = stream_exposures(scene, plan, estimators, {.threads = 0, .folder = {}, .progress = {}});
    std::vector<StarMotion> motions = target_motions(*scene);
    if (jitter != JitterModel::kNone) {
      const double law = motions[0].bin.sxx + motions[0].bin.syy;
      const AttitudeCovariance covariance = hourly_covariance(*make_attitude_series(*scene, *plan));
      for (std::size_t t = 0; t < motions.size(); ++t)
        motions[t].bin = motion_covariance(scene->stars()[scene->targets()[t]].motion, covariance);
      noise.realised += (motions[0].bin.sxx + motions[0].bin.syy) / law / seeds;
    }
    const RunSetup setup = run_setup(mission);
    for (std::size_t t = 0; t < estimators.size(); ++t) {
      const double share = 1.0 / (kStars * seeds);
      const NoiseByCause predicted = predict_noise(estimators[t], motions[t], setup).bin;
      const double sigma = result.series[t].bin_means.value * c4(result.series[t].bins);
      constexpr double kPpmSquared = 1e-12;
      noise.measured += share * sigma * sigma;
      noise.jitter += share * kPpmSquared * predicted.jitter * predicted.jitter;
      noise.prnu += share * kPpmSquared * predicted.prnu_jitter * predicted.prnu_jitter;
      noise.rest += share * kPpmSquared *
                    (predicted.total() * predicted.total() - predicted.jitter * predicted.jitter -
                     predicted.prnu_jitter * predicted.prnu_jitter);
    }
  }
  return noise;
}

TEST(JitterNoise, OfAnHourIsThatOfTheMotionThroughTheEdgeOfTheMask) {
  const HourlyNoise noise = hourly_noise(Phases::kSpread, 0.0, JitterModel::kRedNoise, 3);
  const double excess = noise.measured - noise.rest;
  std::printf(
      "hourly jitter noise %.3f ppm rms, predicted %.3f ppm; all other %.3f ppm; attitude variance %.2f of the law's\n",
      1e6 * std::sqrt(excess), 1e6 * std::sqrt(noise.jitter), 1e6 * std::sqrt(noise.rest), noise.realised);
  EXPECT_NEAR(excess / noise.jitter, 1.0, 0.02);
  // The law itself: 3 runs x 29 degrees of freedom x 2 axes.
  EXPECT_NEAR(noise.realised, 1.0, 4.0 * std::sqrt(2.0 / (3 * 29 * 2)));
}

TEST(JitterNoise, OverUnequalPixelsIsThatOfF27) {
  // In the centre of a pixel no light crosses the edge of the mask to first order: only the pixels' differences count.
  const HourlyNoise noise = hourly_noise(Phases::kCentred, 0.01, JitterModel::kRedNoise, 3);
  const double excess = noise.measured - noise.rest - noise.jitter;
  std::printf("PRNU x jitter %.3f ppm rms, predicted %.3f ppm; all other %.3f ppm\n",
              1e6 * std::sqrt(std::max(0.0, excess)), 1e6 * std::sqrt(noise.prnu), 1e6 * std::sqrt(noise.rest));
  // 432 stars, two directions each, draw their pixels: chi-squared with about 864 degrees of freedom; and photons.
  const double pixels = noise.prnu * std::sqrt(2.0 / 864);
  const double photons = (noise.rest + noise.prnu) * std::sqrt(2.0 / (432.0 * 29));
  EXPECT_NEAR(excess, noise.prnu, 3.5 * std::hypot(pixels, photons));
  EXPECT_GT(noise.prnu, noise.rest);
}

TEST(JitterNoise, IsAbsentWhenNothingMoves) {
  const HourlyNoise noise = hourly_noise(Phases::kSpread, 0.01, JitterModel::kNone, 1);
  EXPECT_NEAR(noise.measured / noise.rest, 1.0, 4.0 * std::sqrt(2.0 / (144 * 29)));
}

}  // namespace
}  // namespace astroid
