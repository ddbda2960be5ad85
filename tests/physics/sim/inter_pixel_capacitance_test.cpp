// Inter-pixel capacitance conserves charge, is a 3 x 3 convolution, and correlates the noise of neighbours as stated.
#include "astroid/sim/inter_pixel_capacitance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "astroid/core/pixel_noise.hpp"

namespace astroid {
namespace {

using Electrons2d = Image<double, unit::SampledElectrons>;

constexpr InterPixelCoupling kCoupling{.side = 0.012, .corner = 0.002};

Electrons2d coupled(const Electrons2d& charge) {
  Electrons2d signal(charge.area());
  couple_pixels(charge.view(), kCoupling, signal.view());
  return signal;
}

double sum(const Electrons2d& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

TEST(InterPixelCapacitance, ConservesCharge) {
  for (const auto& [nx, ny] : {std::pair{64, 48}, std::pair{1, 1}, std::pair{1, 9}, std::pair{7, 1}, std::pair{2, 2}}) {
    Electrons2d charge(nx, ny);
    for (std::size_t i = 0; i < charge.size(); ++i)
      charge.pixels()[i] = 1e5 * std::fabs(std::cos(0.7 * static_cast<double>(i * i)));
    EXPECT_NEAR(sum(coupled(charge)) / sum(charge), 1.0, 1e-12) << nx << " x " << ny;
  }
}

TEST(InterPixelCapacitance, SpreadsAPointAsItsKernel) {
  Electrons2d charge(5, 5);
  charge.at(2, 2) = 1e4;
  const Electrons2d signal = coupled(charge);
  EXPECT_NEAR(signal.at(2, 2), 1e4 * kCoupling.own(), 1e-9);
  for (const auto& [x, y] : {std::pair{1, 2}, std::pair{3, 2}, std::pair{2, 1}, std::pair{2, 3}})
    EXPECT_NEAR(signal.at(x, y), 1e4 * kCoupling.side, 1e-11);
  for (const auto& [x, y] : {std::pair{1, 1}, std::pair{3, 1}, std::pair{1, 3}, std::pair{3, 3}})
    EXPECT_NEAR(signal.at(x, y), 1e4 * kCoupling.corner, 1e-11);
  EXPECT_EQ(signal.at(0, 2), 0.0);
}

TEST(InterPixelCapacitance, LeavesAFlatFieldAlone) {
  Electrons2d charge(9, 6);
  std::ranges::fill(charge.pixels(), 1234.5);
  const Electrons2d signal = coupled(charge);
  for (const double value : signal.pixels()) EXPECT_EQ(value, 1234.5);
}

TEST(InterPixelCapacitance, OfPartOfAnImageIsThatOfTheWholeAwayFromTheCut) {
  Electrons2d charge(20, 20);
  for (std::size_t i = 0; i < charge.size(); ++i) charge.pixels()[i] = std::exp(9.0 * std::cos(static_cast<double>(i)));
  const Electrons2d whole = coupled(charge);
  const Rectangle part{4, 6, 9, 7};
  Electrons2d cut(part);
  for (int y = part.y0; y < part.y1(); ++y)
    for (int x = part.x0; x < part.x1(); ++x) cut.at(x, y) = charge.at(x, y);
  const Electrons2d of_cut = coupled(cut);
  for (int y = part.y0 + 1; y < part.y1() - 1; ++y)
    for (int x = part.x0 + 1; x < part.x1() - 1; ++x) EXPECT_EQ(of_cut.at(x, y), whole.at(x, y));
}

TEST(InterPixelCapacitance, CorrelatesPhotonNoiseOfNeighbours) {
  // White noise through the kernel k: variance Σ k², covariance at a shift s Σ k(x) k(x + s).
  constexpr int kSide = 1000;
  constexpr double kMean = 2500.0;
  Electrons2d charge(kSide, kSide);
  const std::vector<double> mean(charge.size(), kMean);
  const Rectangle area = charge.area();
  pixel_poisson(make_stream(7, StreamId{1}, 0, 0), {.areas = {&area, 1}}, mean, charge.pixels());
  const Electrons2d signal = coupled(charge);
  const double a = kCoupling.side;
  const double b = kCoupling.corner;
  const double o = kCoupling.own();
  struct Lag {
    int dx, dy;
    double share;  // of the Poisson variance
  };
  for (const Lag& lag : {Lag{0, 0, o * o + 4.0 * (a * a + b * b)}, Lag{1, 0, 2.0 * o * a + 4.0 * a * b},
                         Lag{0, 1, 2.0 * o * a + 4.0 * a * b}, Lag{1, 1, 2.0 * o * b + 2.0 * a * a}}) {
    double covariance = 0.0;
    double count = 0.0;
    for (int y = 1; y < kSide - 2; ++y) {
      for (int x = 1; x < kSide - 2; ++x) {
        covariance += (signal.at(x, y) - kMean) * (signal.at(x + lag.dx, y + lag.dy) - kMean);
        count += 1.0;
      }
    }
    covariance /= count * kMean;
    // Products of nearly independent normals scatter by 1, squares by sqrt 2; correlations widen it a little.
    const double error = (lag.dx == 0 && lag.dy == 0 ? std::sqrt(2.0) : 1.0) * 1.1 / std::sqrt(count);
    const double z = (covariance - lag.share) / error;
    std::printf("lag (%d, %d): %.5f, expected %.5f, z = %.2f\n", lag.dx, lag.dy, covariance, lag.share, z);
    EXPECT_LT(std::abs(z), 4.0);
  }
}

}  // namespace
}  // namespace astroid
