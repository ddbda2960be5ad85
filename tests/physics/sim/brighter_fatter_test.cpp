// Laws of the brighter-fatter effect: charge is conserved, stars widen with their brightness, symmetric scenes stay
// symmetric, and the photon transfer curve bends.
#include "astroid/sim/brighter_fatter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "astroid/core/pixel_noise.hpp"

namespace astroid {
namespace {

using Electrons2d = Image<double, unit::SampledElectrons>;

double sum(const Electrons2d& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

Electrons2d star(double electrons, double background) {
  Electrons2d image(31, 31);
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x)
      image.at(x, y) =
          background + electrons / 10.0 * std::exp(-0.5 * ((x - 15.0) * (x - 15.0) + (y - 15.0) * (y - 15.0)) / 1.6);
  return image;
}

TEST(BrighterFatter, ConservesCharge) {
  const BoundaryShifts shifts({4e-7, 6e-7, 0.5, 5});
  for (const double electrons : {1e2, 1e5, 8e6}) {
    Electrons2d image = star(electrons, 50.0);
    image.at(0, 0) = 5e5;
    image.at(30, 7) = 3e5;
    const double before = sum(image);
    brighter_fatter(image.view(), shifts);
    EXPECT_NEAR(sum(image), before, 1e-12 * before);
  }
}

TEST(BrighterFatter, LeavesTheBitsAloneAtZeroStrength) {
  Electrons2d image = star(1e5, 3.3);
  const Electrons2d before = image.clone();
  EXPECT_EQ(brighter_fatter(image.view(), BoundaryShifts({0.0, 0.0, 0.5, 3})), 0);
  EXPECT_TRUE(std::ranges::equal(image.pixels(), before.pixels()));
}

TEST(BrighterFatter, LeavesAFlatFieldAloneAwayFromTheEdge) {
  Electrons2d image(24, 24);
  std::ranges::fill(image.pixels(), 1e5);
  brighter_fatter(image.view(), BoundaryShifts({4e-7, 6e-7, 0.5, 4}));
  for (int y = 5; y < 19; ++y)
    for (int x = 5; x < 19; ++x) EXPECT_EQ(image.at(x, y), 1e5);
}

TEST(BrighterFatter, WidensStarsInProportionToTheirBrightness) {
  const auto widening = [](double electrons) {
    const Electrons2d before = star(electrons, 0.0);
    Electrons2d after = before.clone();
    brighter_fatter(after.view(), BoundaryShifts({4e-7, 4e-7, 0.5, 5}));
    const auto moment = [](const Electrons2d& image) {
      double m = 0.0;
      for (int y = 0; y < 31; ++y)
        for (int x = 0; x < 31; ++x) m += image.at(x, y) * ((x - 15.0) * (x - 15.0) + (y - 15.0) * (y - 15.0));
      return m / sum(image);
    };
    EXPECT_LT(after.at(15, 15), before.at(15, 15));
    return moment(after) / moment(before) - 1.0;
  };
  const double faint = widening(1e4);
  const double bright = widening(1e6);
  std::printf("second moment grows by %.3g at 1e4 e-, by %.3g at 1e6 e-\n", faint, bright);
  EXPECT_GT(faint, 0.0);
  EXPECT_NEAR(bright / faint, 100.0, 1e-6 * 100.0);  // second moments are linear in the charge that moves
}

TEST(BrighterFatter, KeepsASymmetricStarSymmetric) {
  Electrons2d image = star(3e6, 100.0);
  brighter_fatter(image.view(), BoundaryShifts({4e-7, 4e-7, 0.5, 5}));
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x) {
      EXPECT_NEAR(image.at(x, y), image.at(30 - x, y), 1e-9 * image.at(x, y));
      EXPECT_NEAR(image.at(x, y), image.at(y, x), 1e-9 * image.at(x, y));
    }
}

TEST(BrighterFatter, NeverMovesMoreThanThereIs) {
  // Shifts of a whole pixel and more: beyond the validity, but charge stays positive and is conserved.
  Electrons2d image = star(1e8, 1.0);
  const double before = sum(image);
  EXPECT_GT(brighter_fatter(image.view(), BoundaryShifts({1e-5, 1e-5, 0.5, 3})), 0);
  for (const double pixel : image.pixels()) EXPECT_GE(pixel, 0.0);
  EXPECT_NEAR(sum(image), before, 1e-12 * before);
}

TEST(BrighterFatter, OfAWindowIsThatOfTheFrame) {
  const BoundaryShifts shifts({4e-7, 6e-7, 0.4, 4});
  Electrons2d frame(60, 50);
  std::size_t i = 0;
  for (double& pixel : frame.pixels()) pixel = static_cast<double>((++i * 2654435761U) % 90000U);
  // A window with the pixels around it that it depends on; at the edge of the frame there are none.
  const Rectangle wanted{0, 20, 9, 8};
  const Rectangle around = intersect({wanted.x0 - 4, wanted.y0 - 4, 17, 16}, {0, 0, 60, 50});
  Electrons2d window(around);
  for (int y = around.y0; y < around.y1(); ++y)
    for (int x = around.x0; x < around.x1(); ++x) window.at(x, y) = frame.at(x, y);
  brighter_fatter(frame.view(), shifts);
  brighter_fatter(window.view(), shifts);
  for (int y = wanted.y0; y < wanted.y1(); ++y)
    for (int x = wanted.x0; x < wanted.x1(); ++x) EXPECT_EQ(window.at(x, y), frame.at(x, y)) << x << ' ' << y;
}

TEST(BrighterFatter, BendsThePhotonTransferCurve) {
  // Variance / mean of a flat field is 1 + slope mean + (mean / 2)² sum of a²; covariances make up for it.
  constexpr int kSide = 700;
  const BoundaryShifts shifts({4e-7, 6e-7, 0.5, 2});
  const RandomStream stream = make_stream(5, StreamId{7}, 0, 0);
  const Rectangle area{0, 0, kSide, kSide};
  const std::vector<Rectangle> areas{area};
  double last = 2.0;
  for (const double mean : {1e3, 3e4, 1e5, 2e5}) {
    const std::vector<double> means(area.size(), mean);
    Electrons2d image(area);
    pixel_poisson(stream, {.areas = areas, .exposure = static_cast<std::uint32_t>(mean)}, means, image.pixels());
    EXPECT_EQ(brighter_fatter(image.view(), shifts), 0);
    constexpr int kEdge = 4;
    double variance = 0.0;
    double all = 0.0;  // variance and covariances with pixels up to 5 away: what binning would see
    const double n = (kSide - 2.0 * kEdge - 10.0) * (kSide - 2.0 * kEdge - 10.0);
    for (int y = kEdge + 5; y < kSide - kEdge - 5; ++y)
      for (int x = kEdge + 5; x < kSide - kEdge - 5; ++x) {
        const double d = image.at(x, y) - mean;
        variance += d * d / n;
        double around = 0.0;
        for (int j = -5; j <= 5; ++j)
          for (int i = -5; i <= 5; ++i) around += image.at(x + i, y + j) - mean;
        all += d * around / n;
      }
    double squares = 0.0;  // of the response of a pixel to each other pixel
    {
      Electrons2d unit_charge(21, 21);
      std::ranges::fill(unit_charge.pixels(), mean);
      unit_charge.at(10, 10) += 1.0;
      brighter_fatter(unit_charge.view(), shifts);
      for (int y = 6; y < 15; ++y)
        for (int x = 6; x < 15; ++x) squares += (unit_charge.at(x, y) - mean) * (unit_charge.at(x, y) - mean);
    }
    const double error = std::sqrt(2.0 / n);
    std::printf("mean %.0f e-: variance / mean %.4f, expected %.4f (z %.2f), first order %.4f; with covariances %.3f\n",
                mean, variance / mean, squares, (variance / mean / squares - 1.0) / error,
                1.0 + shifts.photon_transfer_slope() * mean, all / mean);
    EXPECT_NEAR(variance / mean / squares, 1.0, 5.0 * error);
    EXPECT_NEAR(1.0 - squares, -shifts.photon_transfer_slope() * mean, 0.2 * (1.0 - squares) + 1e-6);
    EXPECT_NEAR(all / mean, 1.0, 5.0 * error * 11.0);
    EXPECT_LT(variance / mean, last + 5.0 * error);
    last = variance / mean;
  }
  EXPECT_LT(last, 0.75);
}

}  // namespace
}  // namespace astroid
