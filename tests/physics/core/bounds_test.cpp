#include "astroid/core/bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/core/units.hpp"

namespace astroid {
namespace {

constexpr Rectangle kBox{-20, -20, 41, 41};

struct Stamp {
  std::vector<double> p, dpdx, dpdy;
};

Stamp stamp(double sigma, PixelPosition star = {}) {
  Stamp out{std::vector<double>(kBox.size()), std::vector<double>(kBox.size()), std::vector<double>(kBox.size())};
  const auto psf = make_gaussian_psf(sigma);
  psf->integrate(star, kBox, out.p);
  psf->integrate_gradient(star, kBox, out.dpdx, out.dpdy);
  return out;
}

TEST(NoiseEquivalentArea, OfAPixelatedGaussianReproducesReferenceValues) {
  EXPECT_NEAR(noise_equivalent_area(stamp(0.5).p), 3.762219, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(0.5, {0.5, 0.5}).p), 4.797232, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(0.6).p), 5.372401, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(0.6, {0.5, 0.5}).p), 5.849305, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(0.8).p), 9.083455, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(0.8, {0.5, 0.5}).p), 9.134187, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(1.0).p), 13.624990, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(1.0, {0.5, 0.5}).p), 13.627202, 5e-7);
  EXPECT_NEAR(noise_equivalent_area(stamp(2.0).p), 51.315917, 5e-7);
}

TEST(NoiseEquivalentArea, ApproachesTheContinuousLimit) {
  EXPECT_NEAR(noise_equivalent_area(stamp(2.0).p) / (4.0 * kPi * (4.0 + 1.0 / 12.0)), 1.0, 1e-4);
}

struct Golden {
  double sigma, electrons, background, flux, position;
};

TEST(CramerRaoBounds, ReproduceReferenceValues) {
  constexpr double kHalfDigit = 4e-7;  // of the seven that the reference positions have
  for (const Golden& g :
       {Golden{1.0, 1e5, 0.0, 316.227766, 3.291389e-3}, Golden{1.0, 1e4, 100.0, 110.924282, 1.294261e-2},
        Golden{1.0, 1e4, 1e4, 386.583511, 5.609957e-2}, Golden{0.6, 177100.0, 3531.0, 459.533503, 1.907804e-3}}) {
    const Stamp s = stamp(g.sigma);
    EXPECT_NEAR(flux_bound(s.p, {g.electrons, g.background}) / g.flux, 1.0, 2e-9);
    EXPECT_NEAR(position_bound(s.p, s.dpdx, {g.electrons, g.background}) / g.position, 1.0, kHalfDigit);
    EXPECT_NEAR(position_bound(s.p, s.dpdy, {g.electrons, g.background}) / g.position, 1.0, kHalfDigit);
  }
}

TEST(CramerRaoBounds, TendToTheirLimits) {
  const Stamp s = stamp(2.0);
  // Broadened by the pixel: sigma^2 + 1/12 instead of sigma^2.
  const double variance = 4.0 + 1.0 / 12.0;
  EXPECT_NEAR(flux_bound(s.p, {1e6, 0.0}), 1e3, 1e-6);
  EXPECT_NEAR(position_bound(s.p, s.dpdx, {1e6, 0.0}) / std::sqrt(variance / 1e6), 1.0, 1e-3);
  EXPECT_NEAR(flux_bound(s.p, {1e-3, 1e4}) / std::sqrt(4.0 * kPi * variance * 1e4), 1.0, 1e-3);
  EXPECT_NEAR(position_bound(s.p, s.dpdx, {1.0, 1e4}) / std::sqrt(8.0 * kPi * variance * variance * 1e4), 1.0, 1e-3);
}

TEST(JointBounds, AreNeverBelowTheSingleBounds) {
  for (const PixelPosition at : {PixelPosition{0.0, 0.0}, PixelPosition{0.3, -0.45}}) {
    const Stamp s = stamp(0.6, at);
    const SourceOnBackground star{5e4, 900.0};
    const JointBounds joint = joint_bounds(s.p, s.dpdx, s.dpdy, star);
    EXPECT_GT(joint.flux, flux_bound(s.p, star));
    EXPECT_GE(joint.x, position_bound(s.p, s.dpdx, star) * (1.0 - 1e-14));
    EXPECT_GE(joint.y, position_bound(s.p, s.dpdy, star) * (1.0 - 1e-14));
    EXPECT_NEAR(joint.covariance[0][3], joint.covariance[3][0], 1e-12 * joint.flux * joint.background);
    EXPECT_LT(joint.covariance[0][3], 0.0);  // more background, less star
  }
}

TEST(JointBounds, OfACentredStarSeparatePositionFromFlux) {
  // By symmetry position is independent of flux and background, so its joint bound is the single one.
  const Stamp s = stamp(0.8);
  const SourceOnBackground star{1e4, 500.0};
  const JointBounds joint = joint_bounds(s.p, s.dpdx, s.dpdy, star);
  EXPECT_NEAR(joint.x / position_bound(s.p, s.dpdx, star), 1.0, 1e-12);
  EXPECT_NEAR(joint.covariance[0][1], 0.0, 1e-12 * joint.flux * joint.x);
}

TEST(JointBounds, InUniformNoiseFollowFromTheTwoByTwoInverse) {
  // Flux and flat background of N pixels with variance B: F_ff = sum p^2 / B, F_fb = sum p / B, F_bb = N / B.
  const Stamp s = stamp(0.7);
  const double background = 1e8;
  const JointBounds joint = joint_bounds(s.p, s.dpdx, s.dpdy, {1e-3, background});
  double p = 0.0;
  double p2 = 0.0;
  for (const double value : s.p) {
    p += value;
    p2 += value * value;
  }
  const auto n = static_cast<double>(s.p.size());
  EXPECT_NEAR(joint.flux / std::sqrt(background * n / (n * p2 - p * p)), 1.0, 1e-9);
}

TEST(JointBounds, OfOnePixelAreInfinite) {
  const std::vector<double> p = {1.0};
  const std::vector<double> slope = {0.0};
  const JointBounds joint = joint_bounds(p, slope, slope, {1e4, 100.0});
  EXPECT_TRUE(std::isinf(joint.flux));
  EXPECT_TRUE(std::isinf(joint.x));
}

}  // namespace
}  // namespace astroid
