// Synthetic stars are uniform on the sky: chi^2 over cells of equal area, at a pole too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/catalogues/sky_region.hpp"
#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/core/sphere.hpp"

namespace astroid {
namespace {

constexpr double kLimit = 4.0;  // standard deviations

double uniformity_z(const std::vector<double>& counts, double stars) {
  const double expected = stars / static_cast<double>(counts.size());
  double chi_squared = 0.0;
  for (const double count : counts) chi_squared += (count - expected) * (count - expected) / expected;
  const double freedom = static_cast<double>(counts.size()) - 1.0;
  return (chi_squared - freedom) / std::sqrt(2.0 * freedom);
}

StarCatalogue field_in(const SkyRegion& region, std::uint64_t seed) {
  FieldRequest request;
  request.region = region;
  request.stars = 20000;
  request.seed = seed;
  return make_synthetic_field(request);
}

class UniformCap : public testing::TestWithParam<SkyPosition> {};

TEST_P(UniformCap, HasEqualNumbersInRingsOfEqualArea) {
  SkyRegion cap;
  cap.centre = GetParam();
  cap.radius = Degrees(5.0);
  constexpr double kRings = 40.0;
  const StarCatalogue field = field_in(cap, 4);
  std::vector<double> counts(static_cast<std::size_t>(kRings));
  const double half = std::sin(cap.radius.value() / 2.0 * kPi / 180.0);
  for (const CatalogueStar& star : field.stars) {
    EXPECT_TRUE(contains(cap, star.sky));
    const double sine = std::sin(angular_separation(cap.centre, star.sky).value() / 2.0 * kPi / 180.0) / half;
    counts[static_cast<std::size_t>(std::min(kRings - 1.0, sine * sine * kRings))] += 1.0;
  }
  EXPECT_LT(std::abs(uniformity_z(counts, 20000.0)), kLimit);
}

INSTANTIATE_TEST_SUITE_P(Places, UniformCap,
                         testing::Values(SkyPosition{95.3104, -47.8869}, SkyPosition{0.0, 89.0},
                                         SkyPosition{10.0, 90.0}, SkyPosition{200.0, -90.0}, SkyPosition{359.9, 0.0}));

TEST(UniformCap, HasEqualNumbersInRightAscensionAroundThePole) {
  SkyRegion cap;
  cap.centre = {77.0, 90.0};
  cap.radius = Degrees(3.0);
  std::vector<double> counts(36);
  for (const CatalogueStar& star : field_in(cap, 5).stars) counts[static_cast<std::size_t>(star.sky.ra / 10.0)] += 1.0;
  EXPECT_LT(std::abs(uniformity_z(counts, 20000.0)), kLimit);
}

TEST(UniformBox, HasEqualNumbersOnAGridOfEqualAreas) {
  // A box around the pole, seen in its own frame: columns of longitude, rows of the sine of latitude.
  SkyRegion box;
  box.centre = {30.0, 88.0};
  box.width = Degrees(20.0);
  box.height = Degrees(10.0);
  std::vector<double> counts(100);
  const double top = std::sin(5.0 * kPi / 180.0);
  for (const CatalogueStar& star : field_in(box, 6).stars) {
    EXPECT_TRUE(contains(box, star.sky));
    const Direction d = to_direction(star.sky);
    const double ra = 30.0 * kPi / 180.0;
    const double dec = 88.0 * kPi / 180.0;
    const double outward = std::cos(dec) * (d.x * std::cos(ra) + d.y * std::sin(ra)) + std::sin(dec) * d.z;
    const double east = -d.x * std::sin(ra) + d.y * std::cos(ra);
    const double north = -std::sin(dec) * (d.x * std::cos(ra) + d.y * std::sin(ra)) + std::cos(dec) * d.z;
    const double column = (std::atan2(east, outward) * 180.0 / kPi + 10.0) / 20.0 * 10.0;
    const double row = (north / top + 1.0) / 2.0 * 10.0;
    const auto cell = [](double value) { return static_cast<std::size_t>(std::clamp(value, 0.0, 9.999)); };
    counts[cell(row) * 10 + cell(column)] += 1.0;
  }
  EXPECT_LT(std::abs(uniformity_z(counts, 20000.0)), kLimit);
}

TEST(UniformSky, HasEqualNumbersInBeltsOfEqualArea) {
  SkyRegion sky;
  sky.radius = Degrees(180.0);
  std::vector<double> counts(50);
  for (const CatalogueStar& star : field_in(sky, 7).stars) {
    const double z = (std::sin(star.sky.dec * kPi / 180.0) + 1.0) / 2.0;
    counts[static_cast<std::size_t>(std::min(49.0, z * 50.0))] += 1.0;
  }
  EXPECT_LT(std::abs(uniformity_z(counts, 20000.0)), kLimit);
}

}  // namespace
}  // namespace astroid
