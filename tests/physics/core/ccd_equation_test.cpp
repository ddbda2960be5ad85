#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/noise.hpp"

namespace astroid {
namespace {

constexpr double kAdc = 0.289;  // ADU, as the reference values were computed with

TEST(CcdEquation, ReproducesReferenceValues) {
  CcdEquation terms{.star = 1e5, .pixels = 10, .sky = 1000, .dark = 10, .readout_noise = 10, .adc_noise = kAdc};
  EXPECT_NEAR(ccd_equation_snr(terms), 300.01387343, 5e-9);
  terms.background_pixels = 100;
  EXPECT_NEAR(ccd_equation_snr(terms), 298.52619184, 5e-9);
  EXPECT_NEAR(ccd_equation_snr({.star = 100,
                                .pixels = 10,
                                .background_pixels = 50,
                                .sky = 1000,
                                .dark = 10,
                                .readout_noise = 10,
                                .gain = 25,
                                .adc_noise = kAdc}),
              0.84375696, 5e-9);
  EXPECT_NEAR(
      ccd_equation_snr({.star = 1e5, .pixels = 9, .sky = 945, .readout_noise = 50.2, .gain = 25, .adc_noise = kAdc}),
      275.60116440, 5e-9);
}

TEST(CcdEquation, OfABrightStarIsPhotonNoise) {
  EXPECT_NEAR(ccd_equation_snr({.star = 1e12, .pixels = 10, .sky = 100, .readout_noise = 5}), 1e6, 1e-2);
}

TEST(CcdEquation, AgreesWithTheMaskNoiseForAKnownBackground) {
  const std::vector<double> star = {100.0, 400.0, 90.0};
  const std::vector<double> weights = {1.0, 1.0, 1.0};
  const PixelNoise noise{.background = 30.0, .readout = 6.0, .quantisation = 2.0 / std::sqrt(12.0)};
  const double snr =
      ccd_equation_snr({.star = 590.0, .pixels = 3.0, .sky = 25.0, .dark = 5.0, .readout_noise = 6.0, .gain = 2.0});
  EXPECT_NEAR(nsr_exposure(star, star, weights, noise) * snr, 1.0, 1e-14);
}

}  // namespace
}  // namespace astroid
