#include "astroid/analysis/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace astroid {
namespace {

constexpr double kTimescale = 250.0;  // s
constexpr Cadence kPlato{21.0, 25.0, 144};

TEST(RedNoiseRetained, ReproducesThePublishedFactors) {
  const RetainedVariance points = red_noise_retained(kTimescale, {0.0, 25.0, 144});
  EXPECT_NEAR(std::sqrt(points.bin), 0.360, 5e-4);
  EXPECT_NEAR(std::sqrt(red_noise_retained(kTimescale, kPlato).exposure), 0.986, 5e-4);
}

TEST(RedNoiseRetained, IsWhiteWhenTheTimescaleIsShort) {
  const RetainedVariance kept = red_noise_retained(1e-3, {0.0, 25.0, 144});
  EXPECT_DOUBLE_EQ(kept.exposure, 1.0);
  EXPECT_NEAR(kept.bin, 1.0 / 144.0, 1e-15);
}

TEST(RedNoiseRetained, AveragesNothingWhenTheTimescaleIsLong) {
  const RetainedVariance kept = red_noise_retained(1e12, kPlato);
  EXPECT_NEAR(kept.exposure, 1.0, 1e-9);
  EXPECT_NEAR(kept.bin, 1.0, 1e-8);
}

TEST(RedNoiseRetained, JoinsItsSeriesForShortExposuresSmoothly) {
  const RetainedVariance below = red_noise_retained(1.0, {0.99999e-5, 1.0, 10});
  const RetainedVariance above = red_noise_retained(1.0, {1.00001e-5, 1.0, 10});
  // The closed form loses 2 * 2^-53 / t = 2e-11 there.
  EXPECT_NEAR(below.exposure, above.exposure, 2e-10);
  EXPECT_NEAR(below.bin, above.bin, 2e-10);
}

TEST(RedNoiseRetained, OfASingleExposureBinIsThatOfTheExposure) {
  const RetainedVariance kept = red_noise_retained(kTimescale, {21.0, 25.0, 1});
  EXPECT_DOUBLE_EQ(kept.bin, kept.exposure);
}

TEST(RedNoiseRetained, OfBackToBackExposuresIsThatOfOneLongExposure) {
  const RetainedVariance parts = red_noise_retained(kTimescale, {25.0, 25.0, 8});
  const RetainedVariance whole = red_noise_retained(kTimescale, {200.0, 200.0, 1});
  EXPECT_NEAR(parts.bin, whole.exposure, 1e-13);
}

TEST(StarMotion, TurnsAnglesIntoPixelsAndRollIntoTangentialMotion) {
  Mission mission;
  mission.satellite.jitter = {JitterModel::kRedNoise, Arcseconds(0.038), Arcseconds(0.038),
                              Arcseconds(0.040),      Seconds(250.0),    ""};
  const StarMotion axis = star_motion(mission, 0.0, 0.0);
  const double s = 0.038 / 15.0;  // px
  EXPECT_NEAR(std::sqrt(axis.exposure.sxx), 0.986 * s, 5e-4 * s);
  EXPECT_EQ(axis.exposure.sxy, 0.0);
  const StarMotion edge = star_motion(mission, 2000.0, 0.0);
  const double roll = 0.040 / 206264.80624709636 * 2000.0;  // px along y
  EXPECT_NEAR(edge.exposure.syy / axis.exposure.syy, 1.0 + roll * roll / (s * s), 1e-9);
  EXPECT_EQ(edge.exposure.sxx, axis.exposure.sxx);
}

TEST(StarMotion, IsZeroWithoutJitter) {
  EXPECT_EQ(star_motion(Mission{}, 10.0, 20.0).exposure.sxx, 0.0);
}

}  // namespace
}  // namespace astroid
