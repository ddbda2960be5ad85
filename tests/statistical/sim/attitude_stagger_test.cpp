// Cameras that are read out one after the other see the same path of the attitude at other times.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "astroid/core/jitter_noise.hpp"
#include "astroid/sim/attitude.hpp"

namespace astroid {
namespace {

constexpr double kCycle = 25.0;
constexpr double kExposure = 21.0;
constexpr double kTimescale = 60.0;
constexpr int kSteps = 4;
const std::vector<double> kStaggers{0.0, 6.25, 12.5, 18.75};

std::shared_ptr<const AttitudeModel> camera(double stagger, std::uint64_t seed = 7,
                                            const std::vector<double>& all = kStaggers) {
  JitterSettings jitter;
  jitter.yaw = jitter.pitch = jitter.roll = Arcseconds(1.0);
  jitter.timescale = Seconds(kTimescale);
  SimulationSettings simulation;
  simulation.cycle = Seconds(kCycle);
  simulation.exposure_time = Seconds(kExposure);
  simulation.stagger = Seconds(stagger);
  return make_red_noise_attitude(jitter, simulation, make_stream(seed, StreamId{1}, 0, 0), all);
}

double time_of(double stagger, int exposure, int step) {
  return stagger + exposure * kCycle + (step + 0.5) * kExposure / kSteps;
}

TEST(StaggeredAttitude, HasTheCovarianceOfOneProcessAtAllPairsOfTimes) {
  constexpr int kSeeds = 8000;
  constexpr int kExposures = 2;
  // Instants of the first camera beside those of the others, before and after, within and between exposures.
  double worst = 0.0;
  for (const double stagger : {6.25, 12.5, 18.75}) {
    std::vector<double> sums(kExposures * kSteps * kExposures * kSteps, 0.0);
    for (int seed = 0; seed < kSeeds; ++seed) {
      const auto a = camera(0.0, static_cast<std::uint64_t>(seed))->sample(kExposures, kSteps);
      const auto b = camera(stagger, static_cast<std::uint64_t>(seed))->sample(kExposures, kSteps);
      for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
          sums[i * b.size() + j] += (a[i].yaw * b[j].yaw + a[i].pitch * b[j].pitch + a[i].roll * b[j].roll) / 3.0;
    }
    for (int i = 0; i < kExposures * kSteps; ++i)
      for (int j = 0; j < kExposures * kSteps; ++j) {
        const double apart = time_of(0.0, i / kSteps, i % kSteps) - time_of(stagger, j / kSteps, j % kSteps);
        const double law = std::exp(-std::fabs(apart) / kTimescale);
        const double measured = sums[static_cast<std::size_t>(i * kExposures * kSteps + j)] / kSeeds;
        // Products of two unit normals with correlation r vary by 1 + r²; three axes.
        worst = std::max(worst, std::fabs(measured - law) / std::sqrt((1.0 + law * law) / (3.0 * kSeeds)));
      }
  }
  std::printf("largest of 192 deviations from the law: %.2f sigma\n", worst);
  EXPECT_LT(worst, 4.5);
}

TEST(StaggeredAttitude, HasTheCovarianceOfMeansThatIsStated) {
  constexpr int kSeeds = 3000;
  constexpr int kExposures = 6;
  for (const double stagger : {6.25, 18.75}) {
    double sum = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const auto mean = [&](double s) {
        return attitude_moments(camera(s, static_cast<std::uint64_t>(seed))->sample(kExposures, kSteps)).mean;
      };
      const Attitude a = mean(0.0);
      const Attitude b = mean(stagger);
      sum += (a.yaw * b.yaw + a.pitch * b.pitch + a.roll * b.roll) / 3.0;
    }
    const double law = camera(0.0)->covariance_of_mean(kExposures, Seconds(stagger)).yaw;
    const double variance = camera(0.0)->variance_of_mean(kExposures).yaw;
    // Midpoints of four steps sample the means to better than 1e-3 of the variance.
    const double error = std::sqrt((variance * variance + law * law) / (3.0 * kSeeds)) + 1e-3 * variance;
    std::printf("stagger %.2f s: covariance of means %.4f, law %.4f\n", stagger, sum / kSeeds, law);
    EXPECT_NEAR(sum / kSeeds, law, 4.0 * error);
    EXPECT_LT(law, variance);
  }
}

TEST(StaggeredAttitude, OfOneStaggerIsThatWithoutGroupsToTheBit) {
  const auto with = camera(0.0, 7, {0.0, 0.0})->sample(5, kSteps);
  const auto without = camera(0.0, 7, {})->sample(5, kSteps);
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_EQ(with[i].yaw, without[i].yaw) << i;
}

TEST(StaggeredAttitude, OfALongerSeriesBeginsWithTheShorterOne) {
  for (const double stagger : kStaggers) {
    const auto two = camera(stagger)->sample(2, kSteps);
    const auto nine = camera(stagger)->sample(9, kSteps);
    for (std::size_t i = 0; i < two.size(); ++i) EXPECT_EQ(two[i].roll, nine[i].roll) << stagger << " " << i;
  }
}

TEST(StaggeredAttitude, IsTheSameAtTheSameTimeWhicheverExposureItBelongsTo) {
  // Exposures of 25 s without a gap: a stagger of a quarter of them shifts the instants by one step.
  JitterSettings jitter;
  jitter.yaw = Arcseconds(1.0);
  SimulationSettings simulation;
  simulation.cycle = simulation.exposure_time = Seconds(25.0);
  const std::vector<double> staggers{0.0, 6.25};
  const RandomStream stream = make_stream(7, StreamId{1}, 0, 0);
  const auto first = make_red_noise_attitude(jitter, simulation, stream, staggers)->sample(4, 4);
  simulation.stagger = Seconds(6.25);
  const auto second = make_red_noise_attitude(jitter, simulation, stream, staggers)->sample(3, 4);
  for (std::size_t i = 0; i < second.size(); ++i) EXPECT_DOUBLE_EQ(second[i].yaw, first[i + 1].yaw) << i;
}

}  // namespace
}  // namespace astroid
