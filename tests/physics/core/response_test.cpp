// The response of the electronics and the way back.
#include "astroid/core/response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace astroid {
namespace {

// PlatoSim's camera: ±1 % over the range of a 16-bit converter.
constexpr ElectronicResponse kPlato{.a0 = 0.0, .a1 = -0.0042789409, .a2 = 2.365e-7};

TEST(ElectronicResponse, InverseUndoesIt) {
  constexpr double kFourUlp = 4.0 * std::numeric_limits<double>::epsilon();
  const ElectronicResponse others[] = {kPlato,
                                       {.a0 = 3.0, .a1 = 0.02, .a2 = -1e-6},
                                       {.a0 = -1.0, .a1 = 0.0, .a2 = 1e-30},
                                       {.a0 = 0.5, .a1 = -0.3, .a2 = 0.0},
                                       {.a0 = 0.0, .a1 = 0.0, .a2 = -7e-6}};
  for (const ElectronicResponse& response : others) {
    ASSERT_TRUE(response.rises(-100.0, 65535.0));
    for (double signal = -100.0; signal < 65535.0; signal += 37.31) {
      // Where the slope is small, a rounding error of the output is a large one of the signal.
      const double scale = (std::fabs(signal) + std::fabs(response.a0)) / response.slope(signal);
      EXPECT_NEAR(response.in(response.out(signal)), signal, kFourUlp * scale) << signal;
    }
  }
}

TEST(ElectronicResponse, LinearOnesAreTheIdentityBitForBit) {
  constexpr ElectronicResponse kLinear;
  EXPECT_TRUE(kLinear.is_linear());
  for (const double signal : {-3.7, 0.0, 0.1, 65535.0, 1e300}) {
    EXPECT_EQ(kLinear.out(signal), signal);
    EXPECT_EQ(kLinear.in(signal), signal);
  }
}

TEST(ElectronicResponse, StaysFiniteBeyondItsExtremum) {
  constexpr ElectronicResponse kFalling{.a0 = 0.0, .a1 = 0.0, .a2 = -1e-5};  // highest at 50,000 ADU: 25,000
  EXPECT_FALSE(kFalling.rises(0.0, 65535.0));
  EXPECT_NEAR(kFalling.in(25000.0), 50000.0, 1.0);
  EXPECT_EQ(kFalling.in(30000.0), 60000.0);  // beyond the extremum, but finite
}

TEST(ElectronicResponse, ArraysDoWhatTheFunctionsDo) {
  std::vector<double> values{990.0, 1000.0, 12000.3, 60000.0};
  std::vector<float> counts;
  constexpr double kBias = 1000.0;
  const std::vector<double> before = values;
  bend(kPlato, kBias, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(values[i], kBias + kPlato.out(before[i] - kBias));
    counts.push_back(static_cast<float>(values[i]));
  }
  unbend(kPlato, kBias, counts);
  for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_NEAR(counts[i], before[i], 1e-7 * before[i]);
  // The bend matters: 1 % at the top of the range.
  EXPECT_GT(values[3] - before[3], 500.0);
}

}  // namespace
}  // namespace astroid
