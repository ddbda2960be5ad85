// Proper motion: straight lines in space, seen on the sky.
#include "astroid/catalogues/proper_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

TEST(ProperMotion, OfBarnardsStarInFiftyYears) {
  // Gaia DR3: 269.448503, 4.739420 at J2016.0, pm -801.551, 10362.394 mas/yr; to J1966, by hand in the tangent plane.
  const SkyPosition then = moved({269.448503, 4.739420}, {-801.551, 10362.394}, -50.0);
  const auto plane = gnomonic(then, {269.448503, 4.739420});
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->xi * 3.6e6, 801.551 * 50.0, 1e-4);
  EXPECT_NEAR(plane->eta * 3.6e6, -10362.394 * 50.0, 1e-4);
}

TEST(ProperMotion, CrossesThePole) {
  // 1 deg from the pole, moving north by 2 deg in a thousand years: it comes down on the other side.
  const double tangent = std::tan(2.0 * std::acos(-1.0) / 180.0) * 180.0 / std::acos(-1.0);
  const SkyPosition there = moved({30.0, 89.0}, {0.0, tangent * 3600.0}, 1000.0);
  EXPECT_NEAR(there.ra, 210.0, 1e-9);
  EXPECT_NEAR(there.dec, 89.0, 1e-9);
}

TEST(ProperMotion, WithoutMotionOrTimeLeavesThePlaceBitForBit) {
  const SkyPosition place{123.456789, -45.678901234};
  EXPECT_EQ(moved(place, {}, 12.0).ra, place.ra);
  EXPECT_EQ(moved(place, {100.0, 100.0}, 0.0).dec, place.dec);
}

TEST(ProperMotion, GoesBackTheWayItCame) {
  // Near the equator, where east and north are the same at both ends.
  const SkyPosition place{10.0, 0.0};
  const SkyPosition there = moved(place, {500.0, -300.0}, 20.0);
  const SkyPosition back = moved(there, {500.0, -300.0}, -20.0);
  EXPECT_LT(angular_separation(place, back).value() * 3.6e6, 0.01);
}

TEST(ProperMotion, IsReadWithItsEpoch) {
  const test::TemporaryFolder folder;
  const StarCatalogue gaia = read_catalogue(
      folder.write(
          "gaia.csv",
          "source_id,ra,dec,phot_g_mean_mag,pmra,pmdec,ref_epoch\n1,10,20,9,5.5,-7,2016.0\n2,11,20,9,,,2016.0\n"),
      {});
  EXPECT_EQ(gaia.stars[0].pm_ra, 5.5);
  EXPECT_EQ(gaia.stars[0].pm_dec, -7.0);
  EXPECT_EQ(gaia.stars[0].epoch, 2016.0);
  EXPECT_EQ(gaia.stars[1].pm_ra, 0.0);
  const StarCatalogue tycho =
      read_catalogue(folder.write("tycho.csv", "RAJ2000,DEJ2000,VTmag,pmRA,pmDE\n10,20,9,5.5,-7\n"), {});
  EXPECT_EQ(tycho.stars[0].pm_dec, -7.0);
  EXPECT_EQ(tycho.stars[0].epoch, 0.0);
  EXPECT_NEAR(julian_year(51544.5), 2000.0, 1e-12);
  EXPECT_NEAR(julian_year(61406.0), 2027.0, 0.001);
}

}  // namespace
}  // namespace astroid
