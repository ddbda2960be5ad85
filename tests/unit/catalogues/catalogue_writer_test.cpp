#include "astroid/catalogues/catalogue_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

StarCatalogue two_stars() {
  StarCatalogue catalogue;
  catalogue.source = "two stars";
  catalogue.passband = "G";
  catalogue.colour_index = "BP-RP";
  catalogue.notes = {"a note\nof two lines"};
  catalogue.stars = {{.id = "A, \"b\" #1",
                      .sky = {1.0 / 3.0, -2.0 / 3.0},
                      .pixel = {},
                      .magnitude = Magnitude(10.1),
                      .electrons = 0,
                      .colour = 0.82,
                      .teff = kUnknown},
                     {.id = "B",
                      .sky = {359.99999999, 90.0},
                      .pixel = {},
                      .magnitude = Magnitude(-1.5),
                      .electrons = 0,
                      .colour = kUnknown,
                      .teff = 5778.0}};
  return catalogue;
}

TEST(CatalogueWriter, GivesTheSameStarsBack) {
  const test::TemporaryFolder folder;
  const StarCatalogue written = two_stars();
  write_catalogue_csv(folder.path() / "two.csv", written);
  const StarCatalogue read = read_catalogue(folder.path() / "two.csv");
  EXPECT_EQ(read.passband, "G");
  EXPECT_EQ(read.colour_index, "BP-RP");
  ASSERT_EQ(read.stars.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.stars[i].sky.ra, written.stars[i].sky.ra);
    EXPECT_EQ(read.stars[i].sky.dec, written.stars[i].sky.dec);
    EXPECT_EQ(read.stars[i].magnitude, written.stars[i].magnitude);
    EXPECT_EQ(std::isnan(read.stars[i].colour), std::isnan(written.stars[i].colour));
    EXPECT_EQ(std::isnan(read.stars[i].teff), std::isnan(written.stars[i].teff));
  }
  EXPECT_EQ(read.stars[0].colour, 0.82);
  EXPECT_EQ(read.stars[1].teff, 5778.0);
  EXPECT_EQ(read.stars[0].id, written.stars[0].id);
}

TEST(CatalogueWriter, PutsNotesInCommentLines) {
  const test::TemporaryFolder folder;
  write_catalogue_csv(folder.path() / "two.csv", two_stars());
  std::ostringstream text;
  text << std::ifstream(folder.path() / "two.csv").rdbuf();
  EXPECT_THAT(text.str(), testing::StartsWith("# source: two stars\n# passband: G\n# a note of two lines\n"
                                              "id,ra,dec,mag,bp_rp,teff\n"));
}

TEST(CatalogueWriter, WritesPixelsAndElectrons) {
  const test::TemporaryFolder folder;
  StarCatalogue catalogue;
  catalogue.positions = PositionKind::kPixel;
  catalogue.brightness = BrightnessKind::kElectrons;
  catalogue.stars = {{.id = "A",
                      .sky = {},
                      .pixel = {10.25, -3.5},
                      .magnitude = {},
                      .electrons = 1e5,
                      .colour = kUnknown,
                      .teff = kUnknown}};
  write_catalogue_csv(folder.path() / "pixels.csv", catalogue);
  const StarCatalogue read = read_catalogue(folder.path() / "pixels.csv");
  EXPECT_EQ(read.positions, PositionKind::kPixel);
  EXPECT_EQ(read.brightness, BrightnessKind::kElectrons);
  EXPECT_EQ(read.stars.front().pixel.x, 10.25);
  EXPECT_EQ(read.stars.front().electrons, 1e5);
}

}  // namespace
}  // namespace astroid
