// Laws of the readout chain: nodes, cross-talk, non-linearity, drifts, bad pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/response.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 128;
constexpr int kRows = 96;

/// A flat image of 1e4 e- a pixel without photon noise, 24 bits at 1 e-/ADU.
Mission flat() {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.ccd.dark_current = ElectronsPerSecond(1e4 / 21.0);
  return mission;
}

struct Made {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};
Made make(const Mission& mission, const std::vector<test::LabStar>& stars = {{20.3, 30.6, 1e4}}) {
  Made made;
  made.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  made.plan = std::make_shared<const Plan>(make_plan(*made.scene));
  return made;
}

/// The analogue signal after an effect of one exposure.
std::vector<double> analog_after(const Made& made, const char* effect, std::int64_t exposure) {
  const Simulator simulator(made.scene, made.plan, 0);
  ExposureState state = simulator.make_state();
  std::vector<double> analog;
  simulator.simulate(exposure, state, [&](const EffectSpec& spec, const ExposureState& s) {
    if (spec.name == effect) analog.assign(s.analog.whole().pixels().begin(), s.analog.whole().pixels().end());
  });
  return analog;
}

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kColumns + static_cast<std::size_t>(x);
}

TEST(NodesOfADetector, DivideBySeparateGains) {
  Mission mission = flat();
  mission.ccd.nodes = {.count = 4, .gain_factor = {1.0, 1.1, 0.9, 1.25}, .noise_factor = {}, .cross_talk = 0.0};
  const std::vector<double> one = analog_after(make(flat()), "gain", 0);
  const std::vector<double> four = analog_after(make(mission), "gain", 0);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const double factor = y < kRows / 2 ? (x < kColumns / 2 ? 1.0 : 1.1) : (x < kColumns / 2 ? 0.9 : 1.25);
      ASSERT_NEAR(four[at(x, y)], one[at(x, y)] / factor, 1e-12 * one[at(x, y)]) << x << "," << y;
    }
}

TEST(NodesOfADetector, HaveTheirOwnNoise) {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.ccd.readout_noise = Electrons(40.0);
  const Made quiet = make(mission, {{20.3, 30.6, 100.0}});
  mission.ccd.nodes = {.count = 2, .gain_factor = {}, .noise_factor = {1.0, 1.5}, .cross_talk = 0.0};
  const Made loud = make(mission, {{20.3, 30.6, 100.0}});
  const std::vector<double> a = analog_after(quiet, "gain", 3);
  const std::vector<double> b = analog_after(loud, "gain", 3);
  double square = 0.0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      // The same draws, scaled; the star is far from the right half.
      ASSERT_NEAR(b[at(x, y)], (x < kColumns / 2 ? 1.0 : 1.5) * a[at(x, y)], 1e-9) << x << "," << y;
      if (x >= kColumns / 2) square += b[at(x, y)] * b[at(x, y)];
    }
  const double pixels = 0.5 * kColumns * kRows;
  const double z = (square / pixels / 3600.0 - 1.0) * std::sqrt(0.5 * pixels);
  std::printf("variance of the second node: z %+.2f\n", z);
  EXPECT_LT(std::fabs(z), 4.0);
}

TEST(CrossTalkBetweenNodes, LeavesAGhostAtTheMirroredPlace) {
  const std::vector<test::LabStar> star{{20.3, 30.6, 1e7}};
  Mission mission = test::bare_mission(kColumns, kRows);
  for (const int count : {2, 4}) {
    mission.ccd.nodes.count = count;
    mission.ccd.nodes.cross_talk = 2e-3;
    const Made made = make(mission, star);
    ASSERT_TRUE(made.plan->runs("cross-talk"));
    const std::vector<double> before = analog_after(made, "gain", 0);
    const std::vector<double> after = analog_after(made, "cross-talk", 0);
    double ghosts = 0.0;
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) {
        const int mx = kColumns - 1 - x;
        const int my = kRows - 1 - y;
        double heard = before[at(mx, y)];
        if (count == 4) heard += before[at(x, my)] + before[at(mx, my)];
        const double ghost = after[at(x, y)] - before[at(x, y)];
        ASSERT_NEAR(ghost, 2e-3 * heard, 1e-9) << x << "," << y;
        ghosts += ghost;
      }
    EXPECT_NEAR(ghosts / (2e-3 * 1e7), count - 1, 0.01);
  }
}

TEST(NonLinearityOfElectronics, IsThePolynomialOfTheSignalAboveTheBias) {
  Mission mission = flat();
  mission.ccd.bias = Adu(1000.0);
  mission.ccd.electronics.nonlinearity = {0.5, -0.0042789409, 2.365e-7};
  const Made made = make(mission, {{64.2, 40.1, 2e5}});
  const std::vector<double> before = analog_after(made, "gain", 0);
  const std::vector<double> after = analog_after(made, "non-linearity", 0);
  const ElectronicResponse response{0.5, -0.0042789409, 2.365e-7};
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(after[i], response.out(before[i]));
}

TEST(SlowDrift, OfGainAndBiasFollowsTime) {
  Mission mission = flat();
  mission.simulation.exposures = 9;
  mission.ccd.electronics.gain_drift = 0.02;
  mission.ccd.electronics.bias_drift = 4.0;
  mission.ccd.electronics.drift_period = Seconds(200.0);
  const Made still = make(flat());
  const Made drifting = make(mission);
  for (const std::int64_t exposure : {0, 1, 3, 8}) {
    const double phase = std::sin(2.0 * M_PI * (25.0 * static_cast<double>(exposure) + 10.5) / 200.0);
    const std::vector<double> expected = analog_after(still, "gain", exposure % 4);
    const std::vector<double> gain = analog_after(drifting, "gain", exposure);
    const std::vector<double> bias = analog_after(drifting, "bias-drift", exposure);
    // Photon noise differs between exposures; levels are those of a dark corner without a star.
    double ratio = 0.0;
    double shift = 0.0;
    for (std::size_t i = 0; i < gain.size(); ++i) {
      ratio += gain[i] / expected[i] / static_cast<double>(gain.size());
      shift += (bias[i] - gain[i]) / static_cast<double>(gain.size());
    }
    EXPECT_NEAR(ratio * (1.0 + 0.02 * phase), 1.0, 6e-4) << exposure;  // 4 sigma of 1 % in 12,288 pixels, twice
    EXPECT_NEAR(shift, 4.0 * phase, 1e-9) << exposure;
  }
}

TEST(RowOffsets, AreSharedByARowAndNewInEachExposure) {
  Mission mission = flat();
  mission.ccd.electronics.row_offset = 7.0;
  mission.ccd.nodes.count = 2;
  const Made made = make(mission);
  double square = 0.0;
  double product = 0.0;
  for (const std::int64_t exposure : {0, 1}) {
    const std::vector<double> before = analog_after(made, "gain", exposure);
    const std::vector<double> after = analog_after(made, "row-offset", exposure);
    for (int y = 0; y < kRows; ++y) {
      const double left = after[at(0, y)] - before[at(0, y)];
      const double right = after[at(kColumns - 1, y)] - before[at(kColumns - 1, y)];
      for (int x = 0; x < kColumns; ++x)
        ASSERT_NEAR(after[at(x, y)] - before[at(x, y)], x < kColumns / 2 ? left : right, 1e-9);
      square += (left * left + right * right) / (4.0 * kRows);
      product += left * right / (2.0 * kRows);
    }
  }
  const double rows = 4.0 * kRows;
  const double z = (square / 49.0 - 1.0) * std::sqrt(0.5 * rows);
  const double z_product = product / 49.0 * std::sqrt(0.5 * rows);
  std::printf("row offsets: z of the variance %+.2f, of the correlation between nodes %+.2f\n", z, z_product);
  EXPECT_LT(std::fabs(z), 4.0);
  EXPECT_LT(std::fabs(z_product), 4.0);
}

TEST(PickUpNoise, IsASinusoidWithAnotherPhaseInEachExposure) {
  Mission mission = flat();
  mission.ccd.bias = Adu(300.0);
  mission.ccd.electronics.pick_up = {.amplitude = 5.0, .column_frequency = 0.25, .row_frequency = -1.0 / 32.0};
  const Made made = make(mission);
  constexpr double kPixels = kColumns * kRows;  // whole periods of 4 columns and 32 rows
  std::vector<double> phases;
  for (const std::int64_t exposure : {0, 1, 2, 3}) {
    const std::vector<double> before = analog_after(made, "bias", exposure);
    const std::vector<double> after = analog_after(made, "pick-up-noise", exposure);
    double mean = 0.0;
    double square = 0.0;
    double sine = 0.0;
    double cosine = 0.0;
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) {
        const double wave = after[at(x, y)] - before[at(x, y)];
        const double angle = 2.0 * M_PI * (0.25 * x - y / 32.0);
        mean += wave / kPixels;
        square += wave * wave / kPixels;
        sine += 2.0 * wave * std::sin(angle) / kPixels;
        cosine += 2.0 * wave * std::cos(angle) / kPixels;
      }
    EXPECT_NEAR(mean, 0.0, 1e-10);
    EXPECT_NEAR(std::sqrt(square), 5.0 / std::sqrt(2.0), 1e-10);
    EXPECT_NEAR(std::hypot(sine, cosine), 5.0, 1e-10);  // all of it at the frequency asked for
    phases.push_back(std::atan2(cosine, sine));
  }
  for (std::size_t i = 0; i < phases.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(std::fabs(phases[i] - phases[j]), 1e-3) << i << "," << j;
}

TEST(BadPixels, AreAsManyAsAskedForAndFlagged) {
  Mission mission = flat();
  mission.ccd.dark_current = ElectronsPerSecond(0.0);
  mission.field.sky_background = ElectronsPerSecond(1e4 / 21.0);
  mission.ccd.bad_pixels = {.dead = 0.02, .hot = 0.03, .hot_current = ElectronsPerSecond(1000.0)};
  const Made made = make(mission);
  const Simulator simulator(made.scene, made.plan, 0);
  ExposureState state = simulator.make_state();
  simulator.expect(0, state);
  double dead = 0.0;
  double hot = 0.0;
  std::vector<bool> bad;
  for (const double value : state.expected.whole().pixels()) {
    const bool is_dead = value == 0.0 || value == 21000.0;  // some are both
    const bool is_hot = value == 21000.0 || value > 3e4;
    dead += is_dead ? 1.0 : 0.0;
    hot += is_hot ? 1.0 : 0.0;
    bad.push_back(is_dead || is_hot);
  }
  const double pixels = kColumns * kRows;
  const double z_dead = (dead - 0.02 * pixels) / std::sqrt(0.02 * 0.98 * pixels);
  const double z_hot = (hot - 0.03 * pixels) / std::sqrt(0.03 * 0.97 * pixels);
  std::printf("dead: z %+.2f, hot: z %+.2f\n", z_dead, z_hot);
  EXPECT_LT(std::fabs(z_dead), 4.0);
  EXPECT_LT(std::fabs(z_hot), 4.0);
  simulator.simulate(2, state);
  const auto flags = state.frame.flags.pixels();
  for (std::size_t i = 0; i < bad.size(); ++i) ASSERT_EQ((flags[i] & pixel_flag::kBad) != 0, bad[i]) << i;
}

}  // namespace
}  // namespace astroid
