// Cosmic rays: Poisson numbers whatever the area, the charge and length that the model states, and no edge or tile that
// differs from the rest.
#include "astroid/sim/cosmic_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/frame.hpp"

namespace astroid {
namespace {

const RandomStream& stream() {
  static const RandomStream stream = make_stream(2026, StreamId{51}, 0, 0);
  return stream;
}

/// PlatoSim's: 10 hits/cm²/s on pixels of 18 µm during 25 s.
CosmicRayModel trails() {
  CosmicRayModel model;
  model.hits_per_pixel = 10.0 * 18e-4 * 18e-4 * 25.0;
  model.charge_location = 2500.0;
  model.charge_scale = 2000.0;
  model.charge_shape = 30.0;
  model.longest_track = 15.0;
  return model;
}

CosmicRayModel slab() {
  CosmicRayModel model = trails();
  model.is_slab = true;
  model.thickness = 16.0 / 18.0;
  model.electrons_per_path = 80.0 * 18.0;
  model.fluctuation = 0.1;
  model.longest_track = 50.0;
  return model;
}

/// Particles that enter within a rectangle in one exposure.
int number_in(const CosmicRayModel& model, const Rectangle& area, std::uint32_t exposure) {
  int number = 0;
  for (int ty = -2; ty <= area.y1() / kCosmicTile + 1; ++ty)
    for (int tx = -2; tx <= area.x1() / kCosmicTile + 1; ++tx)
      for (const CosmicRay& ray : cosmic_rays_of_tile(model, stream(), tx, ty, {exposure}))
        number += ray.entry.x >= area.x0 - 0.5 && ray.entry.x < area.x1() - 0.5 && ray.entry.y >= area.y0 - 0.5 &&
                  ray.entry.y < area.y1() - 0.5;
  return number;
}

TEST(CosmicRays, AreAPoissonNumberInAnyArea) {
  // A window of 6 x 6 px, a tile, areas across tiles, one with columns before the first.
  CosmicRayModel model = trails();
  for (const Rectangle& area :
       {Rectangle{37, 29, 6, 6}, Rectangle{32, 32, 32, 32}, Rectangle{11, 5, 80, 37}, Rectangle{-20, -9, 23, 30}}) {
    constexpr int kExposures = 4000;
    const double mean = model.hits_per_pixel * static_cast<double>(area.size());
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint32_t exposure = 0; exposure < kExposures; ++exposure) {
      const double deviation = number_in(model, area, exposure) - mean;
      sum += deviation;
      squares += deviation * deviation;
    }
    const double z_mean = sum / std::sqrt(kExposures * mean);
    // Variance of the squared deviation of a Poisson number: mean + 2 mean².
    const double z_variance = (squares - kExposures * mean) / std::sqrt(kExposures * (mean + 2.0 * mean * mean));
    std::printf("%d x %d px: mean %.5f, z of the mean %.2f, of the variance %.2f\n", area.nx, area.ny, mean, z_mean,
                z_variance);
    EXPECT_LT(std::abs(z_mean), 4.0);
    EXPECT_LT(std::abs(z_variance), 4.0);
  }
}

TEST(CosmicRays, OfNeighbouringTilesAreIndependent) {
  constexpr int kExposures = 4000;
  const CosmicRayModel model = trails();
  const double mean = model.hits_per_pixel * kCosmicTile * kCosmicTile;
  for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{1, 1}}) {
    double product = 0.0;
    for (std::uint32_t exposure = 0; exposure < kExposures; ++exposure) {
      const auto deviation = [&](int x, int y) {
        return static_cast<double>(cosmic_rays_of_tile(model, stream(), x, y, {exposure}).size()) - mean;
      };
      product += deviation(0, 0) * deviation(dx, dy);
    }
    const double z = product / (mean * std::sqrt(kExposures));
    std::printf("tiles (0, 0) and (%d, %d): z of the covariance %.2f\n", dx, dy, z);
    EXPECT_LT(std::abs(z), 4.0);
  }
}

TEST(CosmicRays, HaveTheChargeAndTheLengthOfTheModel) {
  for (const CosmicRayModel& model : {trails(), slab()}) {
    std::vector<double> charges;
    double length = 0.0;
    for (std::uint32_t exposure = 0; exposure < 60; ++exposure)
      for (int tile = 0; tile < 400; ++tile)
        for (const CosmicRay& ray : cosmic_rays_of_tile(model, stream(), tile % 20, tile / 20, {exposure})) {
          charges.push_back(ray.electrons);
          length += std::hypot(ray.track.dx, ray.track.dy);
          ASSERT_LE(std::hypot(ray.track.dx, ray.track.dy), model.longest_track * (1.0 + 1e-12));
        }
    const auto n = static_cast<double>(charges.size());
    const CosmicCharge expected = charge_of(model);
    double mean = 0.0;
    for (const double charge : charges) mean += charge / n;
    double variance = 0.0;
    double fourth = 0.0;
    for (const double charge : charges) {
      const double square = (charge - mean) * (charge - mean);
      variance += square / n;
      fourth += square * square / n;
    }
    const double z_mean = (mean - expected.mean) / std::sqrt(expected.variance / n);
    const double z_variance = (variance - expected.variance) / std::sqrt((fourth - variance * variance) / n);
    std::printf("%.0f particles: charge %.1f of %.1f e- (z %.2f), variance ratio %.4f (z %.2f), mean length %.3f px\n",
                n, mean, expected.mean, z_mean, variance / expected.variance, z_variance, length / n);
    EXPECT_LT(std::abs(z_mean), 4.0);
    EXPECT_LT(std::abs(z_variance), 4.0);
    if (!model.is_slab) {
      EXPECT_NEAR(expected.mean, 4094.88, 0.01);
      EXPECT_NEAR(std::sqrt(expected.variance), 1206.8, 0.1);
      EXPECT_NEAR(length / n, 7.5, 4.0 * 15.0 / std::sqrt(12.0 * n));
    }
  }
}

TEST(CosmicRays, LeaveTheSameChargeInEveryRowAndColumn) {
  // The mean of the first and the last row and column is that of the others: hits enter everywhere, and tracks come in
  // from outside.
  CosmicRayModel model = trails();
  model.hits_per_pixel = 0.02;
  constexpr int kSide = 40;
  constexpr int kExposures = 3000;
  Image<double, unit::SampledElectrons> sum(kSide, kSide);
  for (std::uint32_t exposure = 0; exposure < kExposures; ++exposure)
    add_cosmic_rays(model, stream(), {exposure}, sum.view());
  const CosmicCharge charge = charge_of(model);
  const double expected = kExposures * model.hits_per_pixel * charge.mean * kSide;
  // A particle leaves its charge in one row at most: an upper bound of the variance of a row.
  const double deviation =
      std::sqrt(kExposures * model.hits_per_pixel * (kSide + 15.0) * (charge.mean * charge.mean + charge.variance));
  for (const int line : {0, 1, 20, kSide - 2, kSide - 1}) {
    double row = 0.0;
    double column = 0.0;
    for (int i = 0; i < kSide; ++i) {
      row += sum.at(i, line);
      column += sum.at(line, i);
    }
    std::printf("line %d: z of its row %.2f, of its column %.2f\n", line, (row - expected) / deviation,
                (column - expected) / deviation);
    EXPECT_LT(std::abs(row - expected), 4.0 * deviation);
    EXPECT_LT(std::abs(column - expected), 4.0 * deviation);
  }
}

}  // namespace
}  // namespace astroid
