// Attitudes of windows that begin later than their exposure, as rows of a rolling shutter have them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/core/random.hpp"
#include "astroid/sim/attitude.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

SimulationSettings exposures() {
  SimulationSettings s;
  s.exposures = 3;
  s.cycle = Seconds(10.0);
  s.exposure_time = Seconds(8.0);
  return s;
}
SimulationSettings gapless() {
  SimulationSettings s = exposures();
  s.exposure_time = s.cycle;
  return s;
}

std::vector<Attitude> windows_of(const AttitudeModel& model, std::span<const Seconds> offsets, std::int64_t count,
                                 int steps) {
  std::vector<Attitude> all;
  for_each_exposure_at(model, exposures(), offsets, count, steps,
                       [&](std::span<const Attitude> a) { all.insert(all.end(), a.begin(), a.end()); });
  return all;
}

TEST(AttitudeWindows, AreThoseOfTheirTime) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("attitude.csv", "time_s,yaw,pitch,roll\n0,0,0,0\n100,100,0,-50\n");
  const auto model = make_file_attitude(path.string(), gapless());
  const std::vector<Seconds> offsets{Seconds(0.0), Seconds(3.1), Seconds(9.9)};
  constexpr int kSteps = 16;
  const std::vector<Attitude> all = windows_of(*model, offsets, 3, kSteps);
  ASSERT_EQ(all.size(), 3U * 3U * kSteps);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t exposure = i / (3 * kSteps);
    const double offset = offsets[i / kSteps % 3].value();
    const double time = 10.0 * static_cast<double>(exposure) + offset + (static_cast<double>(i % kSteps) + 0.5) * 0.5;
    EXPECT_NEAR(all[i].yaw, time, 0.25 + 1e-12);  // half a step
    EXPECT_NEAR(all[i].roll, -0.5 * time, 0.125 + 1e-12);
  }
}

TEST(AttitudeWindows, OfALongerSeriesBeginWithTheShorterOne) {
  const JitterSettings jitter{.model = JitterModel::kRedNoise,
                              .yaw = Arcseconds(1.0),
                              .pitch = Arcseconds(2.0),
                              .roll = Arcseconds(3.0),
                              .timescale = Seconds(20.0),
                              .file = {}};
  const auto model = make_red_noise_attitude(jitter, gapless(), make_stream(1, StreamId{1}, 0, 0));
  const std::vector<Seconds> offsets{Seconds(0.0), Seconds(5.0)};
  const std::vector<Attitude> few = windows_of(*model, offsets, 3, 5);
  const std::vector<Attitude> many = windows_of(*model, offsets, 40, 5);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].yaw, many[i].yaw);
}

// Means over windows that begin d apart are as close as the bound says with which bands are chosen: sqrt(2) s d / T.
TEST(AttitudeWindows, DifferByNoMoreThanTheBoundOfBands) {
  const JitterSettings jitter{.model = JitterModel::kRedNoise,
                              .yaw = Arcseconds(1.0),
                              .pitch = Arcseconds(0.0),
                              .roll = Arcseconds(0.0),
                              .timescale = Seconds(6.0),
                              .file = {}};
  const auto model = make_red_noise_attitude(jitter, gapless(), make_stream(1, StreamId{1}, 0, 0));
  constexpr int kSteps = 80;
  constexpr int kExposures = 4000;
  for (const double delay : {0.5, 2.0, 6.0}) {
    const std::vector<Attitude> all =
        windows_of(*model, std::vector<Seconds>{Seconds(0.0), Seconds(delay)}, kExposures, kSteps);
    double squares = 0.0;
    for (std::size_t k = 0; k < kExposures; ++k) {
      double difference = 0.0;
      for (std::size_t i = 0; i < kSteps; ++i)
        difference += (all[(2 * k + 1) * kSteps + i].yaw - all[2 * k * kSteps + i].yaw) / kSteps;
      squares += difference * difference / kExposures;
    }
    const double bound = std::sqrt(2.0) * delay / 8.0;
    EXPECT_LT(std::sqrt(squares), bound) << delay;
    EXPECT_GT(std::sqrt(squares), 0.2 * bound) << "the bound is far from what happens";
  }
}

}  // namespace
}  // namespace astroid
