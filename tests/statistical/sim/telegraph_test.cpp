// The telegraph process: the two-state Markov chain it is said to be, and a pure function of the step.
#include "astroid/sim/telegraph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace astroid {
namespace {

const RandomStream kStream = make_stream(11, StreamId{99}, 1, 0);

std::vector<int> states(const TelegraphProcess& process, int x, std::uint32_t from, std::uint32_t steps) {
  std::vector<int> out;
  for (std::uint32_t k = 0; k < steps; ++k)
    out.push_back(telegraph_is_high(kStream, {x, 3}, process, from + k) ? 1 : 0);
  return out;
}

TEST(Telegraph, HasTheTransitionsOfItsChain) {
  for (const TelegraphProcess& process : {TelegraphProcess{0.3, 0.5}, TelegraphProcess{0.04, 0.2},
                                          TelegraphProcess{1.0, 0.7}, TelegraphProcess{0.9, 0.1}}) {
    constexpr int kPixels = 400;
    constexpr std::uint32_t kSteps = 3000;
    double high = 0.0;
    double up = 0.0;
    double down = 0.0;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
      const std::vector<int> s = states(process, pixel, 0, kSteps);
      for (std::size_t k = 1; k < s.size(); ++k) {
        high += s[k - 1];
        up += s[k - 1] == 0 && s[k] == 1 ? 1.0 : 0.0;
        down += s[k - 1] == 1 && s[k] == 0 ? 1.0 : 0.0;
      }
    }
    const double n = kPixels * (kSteps - 1.0);
    const double p_up = process.renewal * process.high;
    const double p_down = process.renewal * (1.0 - process.high);
    // From a given state each step is an independent trial.
    const double z_up = (up / (n - high) - p_up) / std::sqrt(p_up * (1.0 - p_up) / (n - high));
    const double z_down = (down / high - p_down) / std::sqrt(p_down * (1.0 - p_down) / high);
    // Time in the high state: samples are correlated over (2 - renewal) / renewal steps.
    const double spread =
        std::sqrt(process.high * (1.0 - process.high) * (2.0 - process.renewal) / process.renewal / n);
    const double z_high = (high / n - process.high) / spread;
    std::printf("renewal %.2f high %.2f: z = %.2f (up) %.2f (down) %.2f (share)\n", process.renewal, process.high, z_up,
                z_down, z_high);
    EXPECT_LT(std::abs(z_up), 4.0);
    EXPECT_LT(std::abs(z_down), 4.0);
    EXPECT_LT(std::abs(z_high), 4.0);
  }
}

TEST(Telegraph, HasTheAutocorrelationOfItsTimes) {
  // Stays of 400 s and 100 s seen every 20 s: exp(-lag / 80 s).
  const TelegraphProcess process = TelegraphProcess::of_times({.low = 400.0, .high = 100.0}, 20.0);
  EXPECT_NEAR(process.renewal, 1.0 - std::exp(-20.0 / 80.0), 1e-15);
  EXPECT_NEAR(process.high, 0.2, 1e-15);
  constexpr int kPixels = 20000;
  constexpr std::uint32_t kAt = 5000;
  const double variance = process.high * (1.0 - process.high);
  for (const std::uint32_t lag : {1U, 3U, 8U, 20U}) {
    double covariance = 0.0;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
      const double a = telegraph_is_high(kStream, {pixel, 8}, process, kAt) ? 1.0 : 0.0;
      const double b = telegraph_is_high(kStream, {pixel, 8}, process, kAt + lag) ? 1.0 : 0.0;
      covariance += (a - process.high) * (b - process.high) / kPixels;
    }
    const double expected = std::exp(-20.0 * lag / 80.0);
    // The product's standard deviation is at most (1 - high)² sqrt(high).
    const double z = (covariance / variance - expected) / (0.8 * 0.8 * std::sqrt(0.2) / variance / std::sqrt(kPixels));
    std::printf("lag %u: correlation %.3f, expected %.3f, z = %.2f\n", lag, covariance / variance, expected, z);
    EXPECT_LT(std::abs(z), 4.0);
  }
}

TEST(Telegraph, IsAFunctionOfTheStepAlone) {
  const TelegraphProcess process = TelegraphProcess::of_times({.low = 3000.0, .high = 500.0}, 25.0);
  const std::vector<int> whole = states(process, 5, 0, 2000);
  const std::vector<int> second_half = states(process, 5, 1000, 1000);
  EXPECT_TRUE(std::equal(second_half.begin(), second_half.end(), whole.begin() + 1000));
  for (std::uint32_t k = 2000; k-- > 0;)  // backwards as well as forwards
    EXPECT_EQ(telegraph_is_high(kStream, {5, 3}, process, k) ? 1 : 0, whole[k]);
}

TEST(Telegraph, StaysWhereItIsWhenItNeverForgets) {
  int high = 0;
  for (int pixel = 0; pixel < 400; ++pixel) {
    const TelegraphProcess process{1e-15, 0.5};
    const bool state = telegraph_is_high(kStream, {pixel, 1}, process, 0);
    EXPECT_EQ(telegraph_is_high(kStream, {pixel, 1}, process, 4'000'000'000U), state);
    high += state ? 1 : 0;
  }
  EXPECT_NEAR(high, 200.0, 4.0 * std::sqrt(100.0));
  EXPECT_FALSE(telegraph_is_high(kStream, {0, 0}, {0.0, 0.0}, 17));  // renewal 0: as it began
  EXPECT_TRUE(telegraph_is_high(kStream, {0, 0}, {0.0, 1.0}, 17));
}

}  // namespace
}  // namespace astroid
