#include "astroid/analysis/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace astroid {
namespace {

TEST(StarMotion, TurnsAnglesIntoPixelsAndRollIntoTangentialMotion) {
  Mission mission;
  mission.satellite.jitter = {JitterModel::kRedNoise, Arcseconds(0.038), Arcseconds(0.038),
                              Arcseconds(0.040),      Seconds(250.0),    ""};
  const StarMotion axis = star_motion(mission, 0.0, 0.0);
  const double s = 0.038 / 15.0;  // px
  EXPECT_NEAR(std::sqrt(axis.exposure.sxx), 0.986 * s, 5e-4 * s);
  EXPECT_NEAR(std::sqrt(axis.bin.sxx), 0.360 * s, 1e-3 * s);
  EXPECT_EQ(axis.exposure.sxy, 0.0);
  const StarMotion edge = star_motion(mission, 2000.0, 0.0);
  const double roll = 0.040 / 206264.80624709636 * 2000.0;  // px along y
  EXPECT_NEAR(edge.exposure.syy / axis.exposure.syy, 1.0 + roll * roll / (s * s), 1e-9);
  EXPECT_EQ(edge.exposure.sxx, axis.exposure.sxx);
}

TEST(StarMotion, CountsLikePixelNoiseOfOneExposureByWhatItLeavesInABin) {
  // The bin's motion has 2e-6 px²; pixel noise would have fallen to that from 144 × 24 times as much.
  const MotionCovariance motion = motion_like_pixel_noise({2e-6, 5e-7, 1e-6}, 144.0, 24);
  EXPECT_DOUBLE_EQ(motion.sxx, 2e-6 * 144.0 * 24.0);
  EXPECT_DOUBLE_EQ(motion.sxy, 5e-7 * 144.0 * 24.0);
  EXPECT_DOUBLE_EQ(motion.syy, 1e-6 * 144.0 * 24.0);
}

TEST(StarMotion, IsZeroWithoutJitter) {
  EXPECT_EQ(star_motion(Mission{}, 10.0, 20.0).exposure.sxx, 0.0);
}

}  // namespace
}  // namespace astroid
