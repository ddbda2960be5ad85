// Photometry of images that a run wrote, and its comparison with the truth, by hand on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class PhotometryOfImages : public testing::Test {
 protected:
  // Without PRNU, which nothing here calibrates, all errors are those of photons, readout and background.
  void SetUp() override {
    test::write_small_mission(folder_);
    const test::ProgramResult run =
        test::run_astroid({"simulate", "small.xml", "-o", "run", "--set", "Output/Images=every 3", "--set",
                           "CCD/PRNU=0", "--set", "CCD/DSNU=0"},
                          folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  test::TemporaryFolder folder_;
};

TEST_F(PhotometryOfImages, AtCataloguePositionsAgreesWithTheTruthWithinItsErrors) {
  const std::string image = "run/images/camera1_000000.fits";
  const std::vector<std::vector<std::string>> methods{
      {"--method", "aperture", "--radius", "3"},
      {"--method", "mask", "--psf", "gaussian:0.6"},
      {"--method", "weighted", "--psf", "gaussian:0.6"},
      {"--method", "psf", "--psf", "gaussian:0.6"},
      {"--method", "aperture", "--radius", "3", "--background", "mesh"}};
  int number = 0;
  for (const auto& method : methods) {
    const std::string output = "sources" + std::to_string(number++) + ".csv";
    std::vector<std::string> arguments{"photometry", image, "--catalogue", "stars.csv", "-o", output};
    arguments.insert(arguments.end(), method.begin(), method.end());
    const test::ProgramResult run = test::run_astroid(arguments, folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("25 of 25 sources measured, 0 flagged"));
    const test::CsvTable sources = test::read_csv(folder_.path() / output);
    const test::CsvTable truth = test::read_csv(folder_.path() / "run/truth/stars.csv");
    ASSERT_EQ(sources.texts("id"), truth.texts("id"));
    double squares = 0.0;
    for (std::size_t i = 0; i < 25; ++i) {
      const double pull = (sources.numbers("flux")[i] - truth.numbers("electrons")[i]) / sources.numbers("flux_err")[i];
      squares += pull * pull;
      EXPECT_LT(std::abs(pull), 5.0) << sources.texts("id")[i] << ", " << method[1];
    }
    // Five standard errors of the rms of 25 pulls.
    EXPECT_NEAR(std::sqrt(squares / 25.0), 1.0, 5.0 / std::sqrt(50.0)) << method[1];
  }
}

TEST_F(PhotometryOfImages, OfSeveralImagesWritesATableForEach) {
  const test::ProgramResult run = test::run_astroid(
      {"photometry", "run/images/camera1_000000.fits", "run/images/camera1_000003.fits", "--catalogue", "stars.csv"},
      folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  // For each image the method and why, and what was measured.
  EXPECT_EQ(test::lines_of(run.out).size(), 4U);
  for (const char* name : {"sources_camera1_000000.csv", "sources_camera1_000003.csv"})
    EXPECT_EQ(test::read_csv(folder_.path() / name).rows(), 25U) << name;
}

TEST_F(PhotometryOfImages, OfACubeOfWindowsSaysThatItReadOnePlane) {
  ASSERT_EQ(
      test::run_astroid({"simulate", "small.xml", "-o", "windows", "--set", "CCD/Window=14"}, folder_.path()).exit_code,
      0);
  folder_.write("pixels.csv", "id,x,y\nfirst,6.5,6.5\n");
  const test::ProgramResult run = test::run_astroid(
      {"photometry", "windows/images/camera1_000000.fits", "--catalogue", "pixels.csv", "--radius", "2"},
      folder_.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("cube of 25 planes; only plane 0 was read"));
}

TEST_F(PhotometryOfImages, IsComparedWithTheTruthById) {
  ASSERT_EQ(test::run_astroid({"photometry", "run/images/camera1_000000.fits", "--catalogue", "run/truth/stars.csv"},
                              folder_.path())
                .exit_code,
            0);
  const test::ProgramResult run = test::run_astroid(
      {"analyse", "--truth", "run/truth/stars.csv", "--sources", "sources.csv", "-o", "comparison"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("25 of 25 true stars matched with 25 sources"));
  EXPECT_EQ(test::files_below(folder_.path() / "comparison"),
            (std::vector<std::string>{"magnitude_recovery.csv", "matched.csv"}));
  const test::CsvTable matched = test::read_csv(folder_.path() / "comparison/matched.csv");
  for (std::size_t i = 0; i < matched.rows(); ++i) {
    const double expected = -2.5 * std::log10(matched.numbers("flux")[i] / matched.numbers("electrons")[i]);
    EXPECT_NEAR(matched.numbers("delta_mag")[i], expected, 1e-12);
  }
}

TEST_F(PhotometryOfImages, WithoutACatalogueFindsStarsAndSaysWhatItDid) {
  const std::string image = "run/images/camera1_000000.fits";
  const test::ProgramResult circles =
      test::run_astroid({"photometry", image, "-o", "found.csv", "--residual", "residual.fits"}, folder_.path());
  ASSERT_EQ(circles.exit_code, 0) << circles.err;
  EXPECT_THAT(circles.out, HasSubstr("method aperture: no PSF was given"));
  EXPECT_GE(test::read_csv(folder_.path() / "found.csv").rows(), 20U);
  EXPECT_THAT(test::read_file(folder_.path() / "found.csv.json"), HasSubstr("\"method\": \"aperture\""));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "residual.fits"));
  const test::ProgramResult fitted = test::run_astroid(
      {"photometry", image, "--psf", "gaussian:0.6", "--radius", "2", "--background", "mesh", "-o", "fitted.fits"},
      folder_.path());
  ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
  EXPECT_THAT(fitted.err, HasSubstr("--radius was ignored"));
  EXPECT_THAT(fitted.err, HasSubstr("--background was ignored"));
  EXPECT_THAT(test::read_file(folder_.path() / "fitted.fits"), HasSubstr("METHOD  = 'psf"));
}

TEST_F(PhotometryOfImages, RefusesOptionsThatContradictEachOtherAllAtOnce) {
  const test::ProgramResult run = test::run_astroid({"photometry", "run/images/camera1_000000.fits", "--catalogue",
                                                     "stars.csv", "--threshold", "-1", "--method", "psf"},
                                                    folder_.path());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("3 problems"));
}

}  // namespace
}  // namespace astroid
