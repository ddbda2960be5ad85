// Hard cases N24 and N25: a converter that overflows, and one that is too coarse for its noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "astroid/core/digitise.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

TEST(Converter, ClampsWhatDoesNotFit) {
  const std::vector<double> counts{
      65534.6, 65535.4, 65536.0, 1e9, -3.0, std::nan(""), std::numeric_limits<double>::infinity()};
  std::vector<float> digital(counts.size());
  std::vector<std::uint8_t> flags(counts.size());
  digitise_pixels(counts, adc_top(16), digital, flags);
  EXPECT_EQ(digital, (std::vector<float>{65535.0F, 65535.0F, 65535.0F, 65535.0F, 0.0F, 0.0F, 65535.0F}));
  EXPECT_EQ(flags[5] & pixel_flag::kBad, pixel_flag::kBad);
  for (const std::size_t i : {0U, 1U, 2U, 3U, 4U, 6U}) EXPECT_EQ(flags[i], pixel_flag::kAdcSaturated) << i;
}

TEST(Converter, RoundsWithoutBiasAndWithTheVarianceOfAUniform) {
  constexpr std::size_t kPixels = 1 << 18;
  const Rectangle area{0, 0, 1 << 9, 1 << 9};
  std::vector<double> counts(kPixels);
  pixel_uniforms(make_stream(3, StreamId{1}, 0, 0), {.areas = std::span(&area, 1)}, counts);
  for (double& c : counts) c *= 2e4;
  std::vector<float> digital(kPixels);
  std::vector<std::uint8_t> flags(kPixels);
  digitise_pixels(counts, adc_top(16), digital, flags);
  double mean = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const double error = static_cast<double>(digital[i]) - counts[i];
    mean += error / static_cast<double>(kPixels);
    square += error * error / static_cast<double>(kPixels);
  }
  const double z_mean = mean * std::sqrt(12.0 * static_cast<double>(kPixels));
  // The variance of the square of a uniform in ±1/2 is 1/80 - 1/144.
  const double z_variance =
      (square - 1.0 / 12.0) / std::sqrt((1.0 / 80.0 - 1.0 / 144.0) / static_cast<double>(kPixels));
  std::printf("rounding: z of the mean %+.2f, of the variance %+.2f\n", z_mean, z_variance);
  EXPECT_LT(std::fabs(z_mean), 5.0);
  EXPECT_LT(std::fabs(z_variance), 5.0);
}

bool warns(const Mission& mission) {
  const Scene scene(mission, test::lab_catalogue({{15.0, 15.0, 1e5}}));
  const Plan plan = make_plan(scene);
  return std::ranges::any_of(plan.approximations, [](const std::string& note) {
    return note.find("the error of rounding depends on the signal") != std::string::npos;
  });
}

TEST(Converter, PlanWarnsOfNoiseBelowHalfAStep) {
  Mission mission = test::bare_mission(32, 32);
  mission.ccd.gain = Gain(100.0);
  mission.ccd.readout_noise = Electrons(5.0);  // 0.05 ADU
  EXPECT_TRUE(warns(mission));
  mission.ccd.readout_noise = Electrons(60.0);
  EXPECT_FALSE(warns(mission));
  EXPECT_FALSE(warns(test::plato_mission(32, 32)));
}

TEST(Converter, ErrorOfACoarseOneIsNotThatOfAUniform) {
  // What the warning is about: with 0.05 ADU of noise, a level of 0.25 ADU is always rounded to 0.
  std::vector<double> counts(1000);
  const Rectangle area{0, 0, 40, 25};
  add_pixel_normals(make_stream(3, StreamId{2}, 0, 0), {.areas = std::span(&area, 1)}, 0.05, counts);
  for (double& c : counts) c += 0.25;
  std::vector<float> digital(counts.size());
  std::vector<std::uint8_t> flags(counts.size());
  digitise_pixels(counts, adc_top(16), digital, flags);
  EXPECT_TRUE(std::ranges::all_of(digital, [](float value) { return value == 0.0F; }));
}

}  // namespace
}  // namespace astroid
