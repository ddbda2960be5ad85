// Hard case N23 and F29: the exact Ornstein-Uhlenbeck update does not depend on its step.
#include "astroid/sim/attitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr double kRms = 0.038;
constexpr double kTau = 250.0;

std::shared_ptr<const AttitudeModel> model(double cycle, double exposure, std::uint64_t seed = 7) {
  JitterSettings jitter;
  jitter.yaw = jitter.pitch = Arcseconds(kRms);
  jitter.roll = Arcseconds(0.040);
  jitter.timescale = Seconds(kTau);
  SimulationSettings simulation;
  simulation.cycle = Seconds(cycle);
  simulation.exposure_time = Seconds(exposure);
  return make_red_noise_attitude(jitter, simulation, make_stream(seed, StreamId{1}, 0, 0));
}

TEST(OrnsteinUhlenbeck, HasTheSameRmsForAnyStep) {
  for (const double dt : {0.125, 1.0, 25.0, 250.0}) {
    // Long enough for 4000 independent timescales, or 400 where steps are short.
    const auto n = static_cast<std::int64_t>((dt < 1.0 ? 400.0 : 4000.0) * kTau / dt);
    const std::vector<Attitude> a = model(dt, dt)->sample(n, 1);
    double sum = 0.0;
    for (const Attitude& sample : a) sum += sample.yaw * sample.yaw;
    const double rms = std::sqrt(sum / static_cast<double>(n));
    // The squares of an OU process decorrelate with tau/2: relative error of the rms 1/sqrt(2 N_eff), N_eff = T/tau.
    const double effective = static_cast<double>(n) * std::tanh(dt / kTau);
    const double z = (rms / kRms - 1.0) * std::sqrt(2.0 * effective);
    std::printf("dt %.3f s: rms %.5f of %.5f, z = %.2f\n", dt, rms, kRms, z);
    EXPECT_LT(std::abs(z), 4.0);
  }
}

TEST(OrnsteinUhlenbeck, ForgetsWithItsTimescale) {
  const double dt = 25.0;
  const std::int64_t n = 200000;
  const std::vector<Attitude> a = model(dt, dt)->sample(n, 1);
  double sum = 0.0;
  double lagged = 0.0;
  constexpr std::size_t kLag = 10;  // one timescale
  for (std::size_t i = kLag; i < a.size(); ++i) {
    sum += a[i].pitch * a[i].pitch;
    lagged += a[i].pitch * a[i - kLag].pitch;
  }
  EXPECT_NEAR(lagged / sum, std::exp(-1.0), 4.0 / std::sqrt(static_cast<double>(n) * dt / kTau));
}

TEST(OrnsteinUhlenbeck, GapAndStepsMakeTheSameProcess) {
  // Exposures of 21 s in a cycle of 25 s: the covariance of exposure means one cycle apart is that of the formula.
  const auto m = model(25.0, 21.0);
  constexpr int kSteps = 21;
  const std::int64_t n = 100000;
  const std::vector<Attitude> a = m->sample(n, kSteps);
  std::vector<double> mean(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < mean.size(); ++k)
    for (std::size_t i = 0; i < kSteps; ++i) mean[k] += a[k * kSteps + i].yaw / kSteps;
  double variance = 0.0;
  double hourly = 0.0;
  std::size_t hours = 0;
  for (const double v : mean) variance += v * v / static_cast<double>(n);
  for (std::size_t first = 0; first + 144 <= mean.size(); first += 144, ++hours) {
    double sum = 0.0;
    for (std::size_t i = first; i < first + 144; ++i) sum += mean[i];
    hourly += (sum / 144.0) * (sum / 144.0);
  }
  hourly /= static_cast<double>(hours);
  const double own = m->variance_of_mean(1).yaw;
  const double hour = m->variance_of_mean(144).yaw;
  std::printf("exposure mean %.4f (theory %.4f), hourly mean %.4f (theory %.4f) of the rms\n",
              std::sqrt(variance) / kRms, std::sqrt(own) / kRms, std::sqrt(hourly) / kRms, std::sqrt(hour) / kRms);
  EXPECT_NEAR(std::sqrt(own) / kRms, 0.986, 0.0005);
  EXPECT_NEAR(std::sqrt(hour) / kRms, 0.360, 0.005);
  EXPECT_NEAR(variance / own, 1.0, 4.0 * std::sqrt(2.0 / (static_cast<double>(n) * 25.0 / kTau)));
  EXPECT_NEAR(hourly / hour, 1.0, 4.0 * std::sqrt(2.0 / static_cast<double>(hours)));
}

TEST(OrnsteinUhlenbeck, AxesAndSeedsAreIndependent) {
  const std::int64_t n = 20000;
  const std::vector<Attitude> a = model(250.0, 250.0, 1)->sample(n, 1);
  const std::vector<Attitude> b = model(250.0, 250.0, 2)->sample(n, 1);
  double axes = 0.0;
  double seeds = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    axes += a[i].yaw * a[i].pitch / (kRms * kRms);
    seeds += a[i].yaw * b[i].yaw / (kRms * kRms);
  }
  EXPECT_LT(std::abs(axes) / std::sqrt(static_cast<double>(n)), 5.0);
  EXPECT_LT(std::abs(seeds) / std::sqrt(static_cast<double>(n)), 5.0);
}

}  // namespace
}  // namespace astroid
