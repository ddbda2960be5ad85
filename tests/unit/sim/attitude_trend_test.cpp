// Drift and re-pointing: polynomials of each quarter, the same in a longer run.
#include "astroid/sim/attitude_trend.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace astroid {
namespace {

constexpr double kDay = 86400.0;
const RandomStream kStream = make_stream(3, StreamId{20}, 0, 0);

SimulationSettings run(std::int64_t exposures) {
  SimulationSettings simulation;
  simulation.cycle = Seconds(600.0);
  simulation.exposures = exposures;
  return simulation;
}

TEST(AttitudeTrend, IsStillWithoutStrength) {
  const SatelliteSettings satellite;
  EXPECT_TRUE(thermo_elastic_drift(satellite, run(100000), kStream).is_still());
  EXPECT_TRUE(repointing_error(satellite, run(100000), kStream).is_still());
  const auto noise = make_still_attitude();
  EXPECT_EQ(make_drifting_attitude(noise, {}, run(10)), noise);
}

TEST(AttitudeTrend, MovesLinearlyAndBeginsAnewEachQuarter) {
  SatelliteSettings satellite;
  satellite.drift.yaw_rate = Arcseconds(0.2);
  satellite.drift.roll_rate = Arcseconds(-0.1);
  satellite.quarter_days = 90.0;
  const AttitudeTrend trend = thermo_elastic_drift(satellite, run(144 * 200), kStream);
  EXPECT_NEAR(trend.at(10.0 * kDay, 10.0 * kDay).yaw, 2.0, 1e-12);
  EXPECT_NEAR(trend.at(100.0 * kDay, 100.0 * kDay).yaw, 2.0, 1e-12);
  EXPECT_NEAR(trend.at(30.0 * kDay, 30.0 * kDay).roll, -3.0, 1e-12);
  EXPECT_EQ(trend.at(30.0 * kDay, 30.0 * kDay).pitch, 0.0);
  EXPECT_NEAR(trend.farthest().yaw, 18.0, 1e-12);
  EXPECT_NEAR(trend.fastest().roll * kDay, 0.1, 1e-15);
  // An exposure that begins before the spacecraft is pointed anew belongs to the old quarter to its end.
  EXPECT_NEAR(trend.at(90.0 * kDay + 10.0, 90.0 * kDay - 5.0).yaw, 18.0, 1e-4);

  satellite.quarter_days = 0.0;
  const AttitudeTrend endless = thermo_elastic_drift(satellite, run(144 * 200), kStream);
  EXPECT_NEAR(endless.at(100.0 * kDay, 100.0 * kDay).yaw, 20.0, 1e-12);
}

TEST(AttitudeTrend, StaysWithinItsAmplitudeAndStartsAtZero) {
  SatelliteSettings satellite;
  satellite.drift.yaw = satellite.drift.pitch = satellite.drift.roll = Arcseconds(12.0);
  const std::int64_t exposures = 144 * 90 * 40;
  const AttitudeTrend trend = thermo_elastic_drift(satellite, run(exposures), kStream);
  double largest = 0.0;
  int up = 0;
  for (int quarter = 0; quarter < 40; ++quarter) {
    const double begin = quarter * 90.0 * kDay;
    EXPECT_EQ(trend.at(begin, begin).yaw, 0.0);
    for (double day = 1.0; day < 90.0; day += 1.0) {
      const Attitude a = trend.at(begin + day * kDay, begin + day * kDay);
      largest = std::max({largest, std::abs(a.yaw), std::abs(a.pitch), std::abs(a.roll)});
    }
    up += trend.at(begin + 1e4, begin + 1e4).yaw > 0.0 ? 1 : 0;
  }
  EXPECT_LT(largest, 12.0);
  EXPECT_GT(largest, 6.0);
  EXPECT_NEAR(up, 20, 4.0 * std::sqrt(10.0));
  EXPECT_GE(trend.farthest().yaw, 0.0);
  EXPECT_LT(trend.farthest().yaw, 12.0);
}

TEST(AttitudeTrend, PointsAnewEachQuarter) {
  SatelliteSettings satellite;
  satellite.repointing.yaw = satellite.repointing.pitch = Arcseconds(3.0);
  constexpr int kQuarters = 400;
  const AttitudeTrend trend = repointing_error(satellite, run(144 * 90 * kQuarters), kStream);
  EXPECT_EQ(trend.at(50.0, 0.0).yaw, 0.0);
  double squares = 0.0;
  for (int quarter = 1; quarter < kQuarters; ++quarter) {
    const double begin = quarter * 90.0 * kDay;
    const Attitude first = trend.at(begin, begin);
    EXPECT_EQ(first.yaw, trend.at(begin + 80.0 * kDay, begin + 80.0 * kDay).yaw);
    EXPECT_EQ(first.roll, 0.0);
    squares += first.yaw * first.yaw;
  }
  EXPECT_NEAR(squares / (kQuarters - 1) / 9.0, 1.0, 4.0 * std::sqrt(2.0 / kQuarters));
}

TEST(AttitudeTrend, LongerRunBeginsWithTheShorter) {
  SatelliteSettings satellite;
  satellite.drift.yaw = Arcseconds(12.0);
  satellite.repointing.pitch = Arcseconds(1.0);
  const auto both = [&](std::int64_t exposures) {
    return thermo_elastic_drift(satellite, run(exposures), kStream) +
           repointing_error(satellite, run(exposures), kStream);
  };
  const AttitudeTrend shorter = both(144 * 100);
  const AttitudeTrend longer = both(144 * 400);
  for (double day = 0.0; day < 100.0; day += 7.0) {
    const Attitude a = shorter.at(day * kDay, day * kDay);
    const Attitude b = longer.at(day * kDay, day * kDay);
    EXPECT_EQ(a.yaw, b.yaw);
    EXPECT_EQ(a.pitch, b.pitch);
  }
}

TEST(AttitudeTrend, AddsToTheNoise) {
  JitterSettings jitter;
  jitter.yaw = Arcseconds(0.038);
  SatelliteSettings satellite;
  satellite.drift.yaw_rate = Arcseconds(1.0);
  const SimulationSettings simulation = run(300);
  const auto noise = make_red_noise_attitude(jitter, simulation, make_stream(1, StreamId{1}, 0, 0));
  const AttitudeTrend trend = thermo_elastic_drift(satellite, simulation, kStream);
  const auto both = make_drifting_attitude(noise, trend, simulation);
  const auto a = noise->sample(300, 5);
  const auto b = both->sample(300, 5);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double start = static_cast<double>(i / 5) * 600.0;
    const double time = start + (static_cast<double>(i % 5) + 0.5) * 21.0 / 5.0;
    EXPECT_NEAR(b[i].yaw - a[i].yaw, time / kDay, 1e-12);
    EXPECT_EQ(b[i].pitch, a[i].pitch);
  }
  EXPECT_EQ(both->variance().yaw, noise->variance().yaw);
}

}  // namespace
}  // namespace astroid
