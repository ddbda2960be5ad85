#include "astroid/catalogues/catalogue_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using testing::Contains;
using testing::HasSubstr;

StarCatalogue read_text(const std::string& text, const CatalogueOptions& options = {}) {
  const test::TemporaryFolder folder;
  return read_catalogue(folder.write("stars.csv", text), options);
}

TEST(CatalogueReader, ReadsIdRaDecMag) {
  const StarCatalogue catalogue = read_text("id,ra,dec,mag\nA,10.5,-20.25,9.5\nB b,359.9,89,12\n", {.passband = "V"});
  ASSERT_EQ(catalogue.stars.size(), 2U);
  EXPECT_EQ(catalogue.passband, "V");
  EXPECT_EQ(catalogue.positions, PositionKind::kSky);
  EXPECT_EQ(catalogue.brightness, BrightnessKind::kMagnitude);
  EXPECT_EQ(catalogue.stars[0].id, "A");
  EXPECT_EQ(catalogue.stars[1].id, "B b");
  EXPECT_EQ(catalogue.stars[0].sky.ra, 10.5);
  EXPECT_EQ(catalogue.stars[0].sky.dec, -20.25);
  EXPECT_EQ(catalogue.stars[0].magnitude.value(), 9.5);
  EXPECT_TRUE(std::isnan(catalogue.stars[0].colour));
  EXPECT_TRUE(std::isnan(catalogue.stars[0].teff));
}

TEST(CatalogueReader, ReadsGaiaColumnsAndTheirPassband) {
  const StarCatalogue catalogue =
      read_text("source_id,ra,dec,phot_g_mean_mag,bp_rp\n5853498713190525696,217.4,-62.7,8.98,3.8\n");
  EXPECT_EQ(catalogue.passband, "G");
  EXPECT_EQ(catalogue.colour_index, "BP-RP");
  EXPECT_EQ(catalogue.stars.front().id, "5853498713190525696");
  EXPECT_EQ(catalogue.stars.front().colour, 3.8);
}

TEST(CatalogueReader, ReadsVizierTychoColumns) {
  const StarCatalogue catalogue = read_text(
      "TYC;RAJ2000;DEJ2000;BTmag;VTmag\n1-2-1;217.4;-62.7;9.25;8.5\n1-3-1;217.5;-62.7;;8.6\n", {.passband = "VT"});
  EXPECT_EQ(catalogue.passband, "V_T");
  EXPECT_EQ(catalogue.colour_index, "B_T-V_T");
  EXPECT_EQ(catalogue.stars[0].magnitude.value(), 8.5);
  EXPECT_EQ(catalogue.stars[0].colour, 0.75);
  EXPECT_TRUE(std::isnan(catalogue.stars[1].colour));
}

TEST(CatalogueReader, ReadsTicColumnsByTheStatedPassband) {
  const std::string text = "ID,ra,dec,Tmag,GAIAmag,Vmag,Teff\n25155310,63.37,-69.23,10.555,10.97,11.1,5800\n";
  const StarCatalogue tess = read_text(text, {.passband = "T"});
  EXPECT_EQ(tess.stars.front().magnitude.value(), 10.555);
  EXPECT_EQ(tess.stars.front().teff, 5800.0);
  EXPECT_EQ(read_text(text, {.passband = "G"}).stars.front().magnitude.value(), 10.97);
  EXPECT_EQ(read_text(text, {.passband = "V"}).stars.front().magnitude.value(), 11.1);
}

TEST(CatalogueReader, ReadsBareColumns) {
  const StarCatalogue catalogue =
      read_text("178.83199 -70.901917 14.099\n178.841742 -70.919136 14.184\n", {.passband = "V"});
  ASSERT_EQ(catalogue.stars.size(), 2U);
  EXPECT_EQ(catalogue.stars[1].sky.dec, -70.919136);
  EXPECT_EQ(catalogue.stars[1].magnitude.value(), 14.184);
}

TEST(CatalogueReader, ReadsPixelCatalogues) {
  const StarCatalogue magnitudes = read_text("x,y,mag\n10.5,-3,9\n", {.passband = "P"});
  EXPECT_EQ(magnitudes.positions, PositionKind::kPixel);
  EXPECT_EQ(magnitudes.stars.front().pixel.x, 10.5);
  EXPECT_EQ(magnitudes.stars.front().pixel.y, -3.0);
  EXPECT_EQ(magnitudes.stars.front().magnitude.value(), 9.0);
  const StarCatalogue electrons = read_text("id,x,y,electrons\nA,10.5,-3,1e5\n");
  EXPECT_EQ(electrons.brightness, BrightnessKind::kElectrons);
  EXPECT_EQ(electrons.stars.front().electrons, 1e5);
}

TEST(CatalogueReader, ReadsRadians) {
  const StarCatalogue catalogue = read_text("ra,dec,mag\n3.141592653589793,-0.7853981633974483,9\n",
                                            {.passband = "V", .unit = AngleUnit::kRadians});
  EXPECT_DOUBLE_EQ(catalogue.stars.front().sky.ra, 180.0);
  EXPECT_DOUBLE_EQ(catalogue.stars.front().sky.dec, -45.0);
}

TEST(CatalogueReader, ChoosesTheColourOfTheMagnitudesSurvey) {
  const std::string text = "id,ra,dec,Gmag,Vmag,bv,bp_rp\nA,1,2,9,9.1,0.65,0.82\n";
  EXPECT_EQ(read_text(text, {.passband = "G"}).colour_index, "BP-RP");
  EXPECT_EQ(read_text(text, {.passband = "V"}).colour_index, "B-V");
}

TEST(CatalogueReader, TakesMarksForNoColourAsUnknown) {
  const StarCatalogue catalogue =
      read_text("ra,dec,mag,bv,teff\n1,2,9,99.99,0\n1,3,9,,\n1,4,9,nan,--\n", {.passband = "V"});
  for (const CatalogueStar& star : catalogue.stars) {
    EXPECT_TRUE(std::isnan(star.colour));
    EXPECT_TRUE(std::isnan(star.teff));
  }
}

TEST(CatalogueReader, LeavesOutStarsWithoutMagnitudeOnlyWhenAsked) {
  const std::string text = "id,ra,dec,mag\nA,1,2,9\nB,1,3,\nC,1,4,nan\nD,1,5,null\n";
  EXPECT_THROW((void)read_text(text, {.passband = "V"}), InputError);
  const StarCatalogue catalogue = read_text(text, {.passband = "V", .leave_out_missing = true});
  EXPECT_EQ(catalogue.stars.size(), 1U);
  EXPECT_THAT(catalogue.notes, Contains(HasSubstr("3 stars without a magnitude are left out")));
}

TEST(CatalogueReader, AcceptsAWrongDensityWhenToldTo) {
  const auto file = test::source_dir() / "tests/unit/catalogues/broken/radians_as_degrees.csv";
  EXPECT_EQ(read_catalogue(file, {.passband = "V", .check_unit = false}).stars.size(), 300U);
  const StarCatalogue radians = read_catalogue(file, {.passband = "V", .unit = AngleUnit::kRadians});
  EXPECT_NEAR(radians.stars.front().sky.ra, 95.0, 6.0);
}

TEST(StarNames, AreStableHashesOfThePosition) {
  // FNV-1a over the two positions in steps of 1e-7 deg, computed by an independent program.
  const StarCatalogue catalogue = read_text("ra,dec,mag\n178.83199,-70.901917,14.099\n", {.passband = "V"});
  EXPECT_EQ(catalogue.stars.front().id, "hb792ac89357ef0c7");
}

TEST(StarNames, DoNotDependOnTheirNeighboursOrTheOrder) {
  const StarCatalogue all = read_text("ra,dec,mag\n1,2,9\n3,4,10\n5,6,11\n", {.passband = "V"});
  const StarCatalogue some = read_text("ra,dec,mag\n5.00,6.0,11\n3,4,10\n", {.passband = "V"});
  EXPECT_EQ(all.stars[2].id, some.stars[0].id);
  EXPECT_EQ(all.stars[1].id, some.stars[1].id);
  EXPECT_NE(all.stars[0].id, all.stars[1].id);
}

TEST(StarNames, TellDoubleStarsApart) {
  const StarCatalogue catalogue = read_text("ra,dec,mag\n1,2,9\n1,2,10\n", {.passband = "V"});
  EXPECT_EQ(catalogue.stars[1].id, catalogue.stars[0].id + "-2");
  EXPECT_THAT(catalogue.notes, Contains(HasSubstr("1 stars share the position")));
}

TEST(StarNames, FillGapsInAnIdColumn) {
  const StarCatalogue catalogue = read_text("id,ra,dec,mag\nA,1,2,9\n,3,4,10\n", {.passband = "V"});
  EXPECT_EQ(catalogue.stars[0].id, "A");
  EXPECT_EQ(catalogue.stars[1].id.substr(0, 1), "h");
}

}  // namespace
}  // namespace astroid
