// Masks for a Gaussian star in a 6 x 6 window: sizes, noise and contamination against values computed independently.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "astroid/core/noise.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

// PLATO's normal camera as in the reference computation: quantisation is 7.2 e- there.
constexpr PixelNoise kCamera{.background = 945.0, .readout = 50.2, .quantisation = 7.2};
constexpr Magnitude kZeroPoint{20.62};
constexpr Seconds kExposure{21.0};
constexpr double kHour = 144.0;  // exposures
constexpr Rectangle kWindow{0, 0, 6, 6};

// Pixel centres are integers here, so the window coordinate 2.5 of the reference is pixel centre 2.
std::vector<double> star(double magnitude, PixelPosition at) {
  std::vector<double> electrons(kWindow.size());
  make_gaussian_psf(0.6)->integrate(at, kWindow, electrons);
  const double flux = (electron_rate(Magnitude(magnitude), kZeroPoint) * kExposure).value();
  for (double& e : electrons) e *= flux;
  return electrons;
}

double sum_over(const std::vector<double>& values, const std::vector<std::size_t>& mask) {
  return std::accumulate(mask.begin(), mask.end(), 0.0, [&](double s, std::size_t n) { return s + values[n]; });
}

struct Single {
  double magnitude, flux, fraction, nsr, hour24, hour6;
};

TEST(OptimalMask, ReproducesTheReferenceTableOfSingleStars) {
  for (const Single& expected : {Single{10.0, 371722.881, 0.975316, 1.731782e-3, 29.4582, 58.9164},
                                 Single{11.0, 147985.544, 0.975316, 2.906516e-3, 49.4408, 98.8817},
                                 Single{12.0, 58914.106, 0.975316, 5.195210e-3, 88.3723, 176.7446}}) {
    const auto target = star(expected.magnitude, {2.0, 2.0});
    const auto mask = optimal_binary_mask(target, target, kCamera);
    const double flux = (electron_rate(Magnitude(expected.magnitude), kZeroPoint) * kExposure).value();
    const double nsr = nsr_of_mask(target, target, mask, kCamera);
    EXPECT_EQ(mask.size(), 9U);
    EXPECT_NEAR(flux, expected.flux, 5e-4);
    EXPECT_NEAR(sum_over(target, mask) / flux, expected.fraction, 5e-7);
    EXPECT_NEAR(nsr / expected.nsr, 1.0, 1e-6);
    EXPECT_NEAR(nsr_averaged(nsr, kHour, 24).value(), expected.hour24, 5e-5);
    EXPECT_NEAR(nsr_averaged(nsr, kHour, 6).value(), expected.hour6, 1e-4);
  }
}

struct Pair {
  double distance, difference;
  std::size_t pixels;
  double spr, ratio, hour24;
};

TEST(OptimalMask, ReproducesTheReferenceTableOfTwoStars) {
  for (const Pair& expected :
       {Pair{1.0, 0.0, 7, 0.38153972, 0.61691872, 62.6266}, Pair{2.0, 2.0, 9, 0.03144899, 0.03247014, 50.0948}}) {
    const auto target = star(11.0, {2.0, 2.0});
    const auto contaminant = star(11.0 + expected.difference, {2.0 + expected.distance, 2.0});
    std::vector<double> total(target.size());
    std::transform(target.begin(), target.end(), contaminant.begin(), total.begin(), std::plus<>());
    const auto mask = optimal_binary_mask(target, total, kCamera);
    const double spr = sum_over(contaminant, mask) / sum_over(total, mask);
    EXPECT_EQ(mask.size(), expected.pixels);
    EXPECT_NEAR(spr, expected.spr, 1e-7);
    EXPECT_NEAR(contaminant_ratio(spr), expected.ratio, 1e-7);
    EXPECT_NEAR(nsr_averaged(nsr_of_mask(target, total, mask, kCamera), kHour, 24).value(), expected.hour24, 1e-4);
  }
}

TEST(OptimalMask, FindsTheEarthLikeLimitOfAMission) {
  // 84 ppm for 13 h, three transits, significance 7.1, 24 cameras: 73.884 ppm in an hour.
  const double limit = 84.0 * std::sqrt(39.0) / 7.1;
  double bright = 11.0;
  double faint = 13.0;
  for (int i = 0; i < 40; ++i) {
    const double m = 0.5 * (bright + faint);
    const auto target = star(m, {2.0, 2.0});
    const auto mask = optimal_binary_mask(target, target, kCamera);
    (nsr_averaged(nsr_of_mask(target, target, mask, kCamera), kHour, 24).value() < limit ? bright : faint) = m;
  }
  EXPECT_NEAR(bright, 11.707, 1e-3);
}

TEST(MaskGrowth, FollowsTheToyExampleOfTheReferenceCode) {
  const std::vector<double> target = {100, 99, 90, 85, 60, 50};
  const std::vector<double> contaminants = {9, 1, 5, 50, 12, 8};
  std::vector<double> total(target.size());
  std::transform(target.begin(), target.end(), contaminants.begin(), total.begin(), std::plus<>());
  const MaskGrowth growth = grow_mask(target, total, {.background = 45.0, .readout = 50.2, .quantisation = 7.2});
  const std::vector<double> expected = {0.52209961, 0.37072896, 0.31246728, 0.27923606, 0.26866201, 0.26354340};
  ASSERT_EQ(growth.nsr.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(growth.nsr[i], expected[i], 5e-9);
}

TEST(OptimalMask, IsTheGlobalMinimumBehindAPlateau) {
  // The second pixel is bright but contaminated: with it the mask is worse. Twenty faint clean pixels that come after
  // it in the order make up for that. Stopping at the first pixel that does not help, as PlatoSim does, keeps one
  // pixel.
  std::vector<double> target = {100.0, 200.0};
  std::vector<double> total = {200.0, 4000.0};
  target.insert(target.end(), 20, 10.0);
  total.insert(total.end(), 20, 10.5);
  const MaskGrowth growth = grow_mask(target, total, {});
  ASSERT_EQ(growth.order[1], 1U);
  ASSERT_GT(growth.nsr[1], growth.nsr[0]);
  const auto mask = optimal_binary_mask(target, total, {});
  EXPECT_EQ(mask.size(), target.size());
  EXPECT_NEAR(nsr_of_mask(target, total, mask, {}), std::sqrt(4410.0) / 500.0, 1e-15);
  EXPECT_LT(nsr_of_mask(target, total, mask, {}), growth.nsr[0]);
  EXPECT_EQ(growth.allowed, (std::vector<std::size_t>{1, 2, 22}));
}

TEST(OptimalWeights, AreNeverNoisierThanAnyMaskOrAnyOtherWeights) {
  const auto target = star(12.0, {2.3, 1.8});
  const auto contaminant = star(11.0, {4.1, 3.0});
  std::vector<double> total(target.size());
  std::transform(target.begin(), target.end(), contaminant.begin(), total.begin(), std::plus<>());
  const auto weights = optimal_weights(target, total, kCamera);
  const double least = nsr_exposure(target, total, weights, kCamera);
  double information = 0.0;
  for (std::size_t n = 0; n < target.size(); ++n) {
    information += target[n] * target[n] / (total[n] + kCamera.variance());
  }
  EXPECT_NEAR(least * std::sqrt(information), 1.0, 1e-13);
  EXPECT_LT(least, nsr_of_mask(target, total, optimal_binary_mask(target, total, kCamera), kCamera));
  EXPECT_EQ(*std::max_element(weights.begin(), weights.end()), 1.0);
  for (std::size_t n = 0; n < weights.size(); ++n) {
    for (const double change : {-1e-3, 1e-3}) {
      auto other = weights;
      other[n] += change;
      EXPECT_GT(nsr_exposure(target, total, other, kCamera), least);
    }
  }
}

}  // namespace
}  // namespace astroid
