// Right ascension wraps and the poles have none: regions and catalogues must not notice.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/sky_region.hpp"
#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

SkyRegion cap_at(double ra, double dec, double radius) {
  SkyRegion cap;
  cap.centre = {ra, dec};
  cap.radius = Degrees(radius);
  return cap;
}

TEST(SkyRegion, HasTheAreaOfTheWholeSky) {
  constexpr double kSky = 41252.96124941928;  // deg^2: 4 pi (180 / pi)^2
  EXPECT_NEAR(square_degrees(cap_at(10.0, 20.0, 180.0)), kSky, 1e-8);
  SkyRegion box;
  box.width = Degrees(360.0);
  box.height = Degrees(180.0);
  EXPECT_NEAR(square_degrees(box), kSky, 1e-8);
}

TEST(SkyRegion, TinyCapHasAFlatArea) {
  constexpr double kRadius = 1e-6;  // deg
  EXPECT_NEAR(square_degrees(cap_at(0.0, 0.0, kRadius)) / (kPi * kRadius * kRadius), 1.0, 1e-13);
}

TEST(SkyRegion, ContainsBothSidesOfTheWrap) {
  const SkyRegion cap = cap_at(0.0, 0.0, 0.5);
  EXPECT_TRUE(contains(cap, {359.9, 0.0}));
  EXPECT_TRUE(contains(cap, {0.1, 0.0}));
  EXPECT_FALSE(contains(cap, {359.4, 0.0}));
  SkyRegion box;
  box.centre = {359.95, 10.0};
  box.width = Degrees(0.4);
  box.height = Degrees(0.4);
  EXPECT_TRUE(contains(box, {0.1, 10.0}));
  EXPECT_TRUE(contains(box, {359.8, 10.0}));
  EXPECT_FALSE(contains(box, {0.2, 10.0}));
}

TEST(SkyRegion, EdgePointsOfACapAreAtItsRadius) {
  for (const SkyPosition centre : {SkyPosition{0.0, 90.0}, SkyPosition{123.0, -90.0}, SkyPosition{359.99999, 0.0},
                                   SkyPosition{10.0, 89.9999999}}) {
    for (const double v : {0.0, 0.1, 0.25, 0.5, 0.77}) {
      const SkyPosition edge = point_of(cap_at(centre.ra, centre.dec, 2.0), 1.0, v);
      EXPECT_NEAR(angular_separation(centre, edge).value(), 2.0, 1e-12);
      EXPECT_GE(edge.ra, 0.0);
      EXPECT_LT(edge.ra, 360.0);
    }
  }
}

TEST(SkyRegion, CentreOfACapIsThePointAtZero) {
  const SkyPosition centre = point_of(cap_at(95.3104, -47.8869, 8.0), 0.0, 0.3);
  EXPECT_NEAR(centre.ra, 95.3104, 1e-12);
  EXPECT_NEAR(centre.dec, -47.8869, 1e-12);
}

TEST(SyntheticField, AcrossTheWrapHasValidRightAscensions) {
  FieldRequest request;
  request.region = cap_at(0.0, 0.0, 0.2);
  request.stars = 2000;
  int west = 0;
  for (const CatalogueStar& star : make_synthetic_field(request).stars) {
    EXPECT_GE(star.sky.ra, 0.0);
    EXPECT_LT(star.sky.ra, 360.0);
    EXPECT_TRUE(star.sky.ra < 0.21 || star.sky.ra > 359.79) << star.sky.ra;
    west += star.sky.ra > 180.0 ? 1 : 0;
  }
  EXPECT_GT(west, 900);
  EXPECT_LT(west, 1100);
}

TEST(EnclosingCap, IsSmallAcrossTheWrapAndAroundThePole) {
  StarCatalogue wrap;
  for (const double ra : {359.9, 0.1}) wrap.stars.push_back({.id = {}, .sky = {ra, 0.0}, .pixel = {}, .magnitude = {}});
  const SkyRegion cap = enclosing_cap(wrap);
  EXPECT_NEAR(cap.radius.value(), 0.1, 1e-3);
  EXPECT_NEAR(angular_separation(cap.centre, {0.0, 0.0}).value(), 0.0, 1e-3);
  StarCatalogue pole;
  for (const double ra : {0.0, 90.0, 180.0, 270.0}) {
    pole.stars.push_back({.id = {}, .sky = {ra, -89.0}, .pixel = {}, .magnitude = {}});
  }
  EXPECT_NEAR(enclosing_cap(pole).radius.value(), 1.0, 1e-2);
  EXPECT_NEAR(enclosing_cap(pole).centre.dec, -90.0, 1e-2);
}

TEST(EnclosingCap, IsTheDiscOfALopsidedField) {
  // Three quarters of the stars in the western half: the mean direction is not the centre, the smallest cap's is.
  FieldRequest request;
  request.region = cap_at(95.0, -48.0, 8.0);
  request.stars = 20000;
  StarCatalogue field = make_synthetic_field(request);
  std::size_t n = 0;
  std::erase_if(field.stars, [&n](const auto& star) { return star.sky.ra > 95.0 && ++n % 3 != 0; });
  const SkyRegion cap = enclosing_cap(field);
  EXPECT_NEAR(cap.radius.value(), 8.0, 0.08);
  EXPECT_LT(angular_separation(cap.centre, {95.0, -48.0}).value(), 0.08);
}

TEST(EnclosingCap, RefusesAWholeSky) {
  FieldRequest request;
  request.region = cap_at(0.0, 0.0, 180.0);
  request.stars = 5000;
  EXPECT_THROW((void)enclosing_cap(make_synthetic_field(request)), InputError);
}

TEST(CatalogueReader, TakesTheEndsOfTheRanges) {
  const test::TemporaryFolder folder;
  const auto file =
      folder.write("ends.csv", "id,ra,dec,mag\nA,0,-90,1\nB,360,90,2\nC,-0.0,-0.0,3\nD,359.9999999999,0,4\n");
  const StarCatalogue catalogue = read_catalogue(file, {.passband = "V"});
  EXPECT_EQ(catalogue.stars[0].sky.dec, -90.0);
  EXPECT_EQ(catalogue.stars[1].sky.ra, 0.0);
  EXPECT_FALSE(std::signbit(catalogue.stars[2].sky.ra));
  EXPECT_EQ(catalogue.stars[3].sky.ra, 359.9999999999);
}

TEST(StarNames, AreTheSameForZeroAndMinusZero) {
  const test::TemporaryFolder folder;
  const StarCatalogue a = read_catalogue(folder.write("a.csv", "ra,dec,mag\n0,0,1\n"), {.passband = "V"});
  const StarCatalogue b = read_catalogue(folder.write("b.csv", "ra,dec,mag\n-0.0,-0.0,1\n"), {.passband = "V"});
  EXPECT_EQ(a.stars.front().id, b.stars.front().id);
}

TEST(CatalogueReader, TellsAFieldAtTheOriginFromRadians) {
  // A realistic field near (3, 0.5) deg passes for degrees although every number could be radians.
  FieldRequest request;
  request.region = cap_at(3.0, 0.5, 1.0);
  request.passband = "V";
  request.density = 700.0;  // ten times the mean sky
  const StarCatalogue field = make_synthetic_field(request);
  ASSERT_GT(field.stars.size(), 5000U);
  std::string text = "ra,dec,mag\n";
  for (const CatalogueStar& star : field.stars) {
    text += std::to_string(star.sky.ra) + "," + std::to_string(star.sky.dec) + "," +
            std::to_string(star.magnitude.value()) + "\n";
  }
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_catalogue(folder.write("field.csv", text), {.passband = "V"}).stars.size(), field.stars.size());
}

}  // namespace
}  // namespace astroid
