// The PSF of an image measured by the command line, written, read again, and measured with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "astroid/core/fits_writer.hpp"
#include "astroid/test/star_field.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

void write_image(const std::filesystem::path& file, const test::StarField& field) {
  const auto values = field.frame.pixels.view(0);
  Image<float, unit::Adu> image(values.area());
  for (int y = 0; y < image.ny(); ++y)
    for (int x = 0; x < image.nx(); ++x) image.at(x, y) = values.at(x, y);
  FitsWriter fits(file);
  (void)fits.begin_image(FitsNumber::kFloat32, {image.nx(), image.ny()});
  fits.card({"GAIN", 1.0, "e-/ADU"});
  fits.card({"RDNOISE", 5.0, "e-"});
  fits.write_plane(image);
  fits.commit();
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class MeasuredPsfCommand : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(MeasuredPsfCommand, WritesAPsfThatMeasuresTheSameAgain) {
  const test::StarField field = test::make_star_field({.nx = 256, .ny = 256, .stars = 200, .slope = 0.1, .seed = 4});
  write_image(folder_.path() / "field.fits", field);
  test::ProgramResult run =
      test::run_astroid({"photometry", "field.fits", "--method", "psf", "--psf", "measured", "--psf-output", "psf.fits",
                         "--phase-errors", "phases.csv", "-o", "first.csv"},
                        folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("The PSF was measured from"));
  const test::CsvTable phases = test::read_csv(folder_.path() / "phases.csv");
  EXPECT_EQ(phases.rows(), 25U);
  run = test::run_astroid({"photometry", "field.fits", "--method", "psf", "--psf", "psf.fits", "-o", "again.csv"},
                          folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const test::CsvTable first = test::read_csv(folder_.path() / "first.csv");
  const test::CsvTable again = test::read_csv(folder_.path() / "again.csv");
  ASSERT_EQ(first.rows(), again.rows());
  for (std::size_t i = 0; i < first.rows(); ++i) {
    EXPECT_NEAR(again.numbers("flux")[i], first.numbers("flux")[i], 0.01 * first.numbers("flux_err")[i]);
    // The doubt about a PSF is not in its file.
    EXPECT_LE(again.numbers("flux_err")[i], 1.0001 * first.numbers("flux_err")[i]);
  }
}

TEST_F(MeasuredPsfCommand, IsWhatAutoDoesInACrowdWithoutOne) {
  write_image(folder_.path() / "crowd.fits",
              test::make_star_field({.nx = 200, .ny = 200, .stars = 570, .slope = 0.25, .seed = 4}));
  const test::ProgramResult run =
      test::run_astroid({"photometry", "crowd.fits", "--artificial-stars", "60", "-o", "crowd.csv"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("dded stars"));
  double added = 0.0;
  for (const double n : test::read_csv(folder_.path() / "crowd_completeness.csv").numbers("added")) added += n;
  EXPECT_EQ(added, 60.0);
  EXPECT_THAT(run.out, HasSubstr("method psf: no PSF was given, but"));
  EXPECT_THAT(contents(folder_.path() / "crowd.csv.json"), HasSubstr("\"method\": \"psf\""));
}

TEST_F(MeasuredPsfCommand, RefusesWhatContradictsItself) {
  write_image(folder_.path() / "empty.fits", test::make_star_field({.nx = 64, .ny = 64, .stars = 0}));
  test::ProgramResult run = test::run_astroid(
      {"photometry", "empty.fits", "--method", "psf", "--psf", "measured", "-o", "empty.csv"}, folder_.path());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("cannot be measured from this image"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "empty.csv"));
  run = test::run_astroid({"photometry", "empty.fits", "--psf", "gaussian:1", "--psf-output", "psf.fits"},
                          folder_.path());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--psf-output"));
}

}  // namespace
}  // namespace astroid
