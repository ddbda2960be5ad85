// Catalogues in FITS tables: one that astropy wrote, and broken ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

std::filesystem::path astropy_file() {
  return test::source_dir() / "tests/unit/catalogues/data/gaia_by_astropy.fits";
}

struct Table {
  std::string unit = "deg";
  std::vector<std::int64_t> ids{1, 2, 3};
  std::vector<double> ra{10.0, 11.0, 12.0};
  std::vector<double> dec{1.0, 2.0, 3.0};
  std::vector<double> mag{9.0, 10.0, 11.0};
};

std::filesystem::path write_table(const test::TemporaryFolder& folder, const Table& table) {
  std::filesystem::path path = folder.path() / "stars.fits";
  FitsWriter writer(path);
  writer.begin_table({{.name = "ID", .number = FitsNumber::kInt64},
                      {.name = "RAJ2000", .number = FitsNumber::kFloat64, .unit = table.unit},
                      {.name = "DEJ2000", .number = FitsNumber::kFloat64, .unit = table.unit},
                      {.name = "Vmag", .number = FitsNumber::kFloat64, .unit = "mag"}},
                     "STARS");
  writer.write_column(0, 0, std::span<const std::int64_t>(table.ids));
  writer.write_column(1, 0, std::span<const double>(table.ra));
  writer.write_column(2, 0, std::span<const double>(table.dec));
  writer.write_column(3, 0, std::span<const double>(table.mag));
  writer.commit();
  return path;
}

std::string refusal(const std::filesystem::path& path, const CatalogueOptions& options) {
  try {
    (void)read_catalogue(path, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

TEST(FitsCatalogue, ReadsATableOfAstropy) {
  const StarCatalogue catalogue = read_catalogue(astropy_file());
  ASSERT_EQ(catalogue.stars.size(), 3U);
  EXPECT_EQ(catalogue.passband, "G");
  EXPECT_EQ(catalogue.colour_index, "BP-RP");
  EXPECT_EQ(catalogue.stars[0].id, "5853498713190525696");
  EXPECT_EQ(catalogue.stars[0].sky.ra, 217.39232147);
  EXPECT_EQ(catalogue.stars[1].sky.dec, 4.73942005);
  EXPECT_FLOAT_EQ(static_cast<float>(catalogue.stars[1].magnitude.value()), 8.193974F);
  EXPECT_FLOAT_EQ(static_cast<float>(catalogue.stars[0].colour), 3.804586F);
  EXPECT_TRUE(std::isnan(catalogue.stars[2].colour));
}

TEST(FitsCatalogue, ReportsRowAndColumnOfEveryProblem) {
  const test::TemporaryFolder folder;
  Table table;
  table.ids = {1, 2, 1};
  table.dec[1] = 95.0;
  table.mag[2] = std::numeric_limits<double>::quiet_NaN();
  const std::string text = refusal(write_table(folder, table), {.passband = "V"});
  EXPECT_THAT(text, HasSubstr("stars.fits: row 2, column DEJ2000 = 95: out of range; expected -90 .. 90 deg"));
  EXPECT_THAT(text, HasSubstr("stars.fits: row 3, column Vmag = nan: not a number (NaN)"));
  EXPECT_THAT(text, HasSubstr("stars.fits: row 3, column ID = 1: the same id as in row 1"));
}

TEST(FitsCatalogue, RefusesAUnitThatContradictsTheStatedOne) {
  const test::TemporaryFolder folder;
  Table table;
  table.unit = "rad";
  table.ra = {0.1, 0.2, 0.3};
  table.dec = {0.1, 0.2, 0.3};
  const std::filesystem::path path = write_table(folder, table);
  EXPECT_THAT(refusal(path, {.passband = "V"}), HasSubstr("column RAJ2000: the file gives its unit as rad"));
  EXPECT_NEAR(read_catalogue(path, {.passband = "V", .unit = AngleUnit::kRadians}).stars[0].sky.ra, 5.729577951, 1e-9);
}

TEST(FitsCatalogue, ReportsContradictingPassbandsAndMissingColumns) {
  EXPECT_THAT(refusal(astropy_file(), {.passband = "V"}),
              HasSubstr("column phot_g_mean_mag: its magnitudes are in G, but passband V was stated"));
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "spectra.fits";
  FitsWriter writer(path);
  writer.begin_table({{.name = "ra"}, {.name = "flux"}}, "SPECTRA");
  writer.write_column(0, 0, std::span<const double>(std::vector<double>{1.0}));
  writer.write_column(1, 0, std::span<const double>(std::vector<double>{2.0}));
  writer.commit();
  const std::string text = refusal(path, {.passband = "V"});
  EXPECT_THAT(text, HasSubstr("column dec: is missing"));
  EXPECT_THAT(text, HasSubstr("column mag: is missing"));
}

TEST(FitsCatalogue, RefusesImagesAndTruncatedFiles) {
  const test::TemporaryFolder folder;
  const std::filesystem::path image = folder.path() / "image.fits";
  FitsWriter writer(image);
  writer.begin_image(FitsNumber::kFloat32, {4, 4});
  writer.write_pixels(0, std::span<const float>(std::vector<float>(16)));
  writer.commit();
  EXPECT_NE(refusal(image, {.passband = "V"}), "read");
  constexpr std::uintmax_t kBlock = 2880;  // bytes of a FITS block
  const std::filesystem::path truncated = folder.path() / "truncated.fits";
  std::filesystem::copy_file(astropy_file(), truncated);
  std::filesystem::resize_file(truncated, std::filesystem::file_size(truncated) - kBlock);
  EXPECT_NE(refusal(truncated, {.passband = "G"}), "read");
}

}  // namespace
}  // namespace astroid
