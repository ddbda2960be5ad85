// Reference pixels on their way through files: a run writes them beside its images, photometry of images uses them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

class Overscan : public testing::Test {
 protected:
  void SetUp() override {
    test::write_small_mission(folder_);
    const test::ProgramResult run =
        test::run_astroid({"simulate", "small.xml", "-o", "run", "--set", "CCD/PRNU=0", "--set", "CCD/DSNU=0", "--set",
                           "CCD/Smearing/model=open-shutter", "--set", "CCD/ReferencePixels/Prescan=25", "--set",
                           "CCD/ReferencePixels/SerialOverscan=4", "--set", "CCD/ReferencePixels/Overscan=30"},
                          folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  /// Rms of (measured - true) / error over the stars.
  double pull(const std::string& output, const std::vector<std::string>& more, const std::string& note) {
    std::vector<std::string> arguments{"photometry", image_, "--catalogue", "stars.csv", "-o", output, "--radius", "3"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::ProgramResult run = test::run_astroid(arguments, folder_.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(note));
    const test::CsvTable sources = test::read_csv(folder_.path() / output);
    const test::CsvTable truth = test::read_csv(folder_.path() / "run/truth/stars.csv");
    double squares = 0.0;
    for (std::size_t i = 0; i < truth.rows(); ++i) {
      const double p = (sources.numbers("flux")[i] - truth.numbers("electrons")[i]) / sources.numbers("flux_err")[i];
      squares += p * p / static_cast<double>(truth.rows());
    }
    return std::sqrt(squares);
  }
  const std::string image_ = "run/images/camera1_000000.fits";
  test::TemporaryFolder folder_;
};

TEST_F(Overscan, IsWrittenReadBackAndSubtracted) {
  const double corrected = pull("sources.csv", {}, "The mean of 30 overscan rows");
  const double raw = pull("raw.csv", {"--ignore-overscan"}, "");
  std::printf("rms of the pulls: %.2f, without the overscan %.2f\n", corrected, raw);
  EXPECT_NEAR(corrected, 1.0, 5.0 / std::sqrt(50.0));
  EXPECT_GT(raw, 2.0 * corrected);
}

TEST_F(Overscan, IsAcceptedByFitsverify) {
  if (!test::has_program("fitsverify")) GTEST_SKIP() << "fitsverify is not installed";
  const test::ProgramResult verdict = test::run_program({"fitsverify", "-q", image_}, folder_.path());
  EXPECT_EQ(verdict.exit_code, 0) << verdict.out;
}

TEST_F(Overscan, IsUsedByAnAssessment) {
  const test::ProgramResult run = test::run_astroid(
      {"assess", "small.xml", "-o", "assessed", "--set", "CCD/Smearing/model=open-shutter", "--set",
       "CCD/ReferencePixels/Prescan=25", "--set", "CCD/ReferencePixels/Overscan=30", "--set",
       "Photometry/Calibration/Smearing=on", "--set", "Photometry/Calibration/Bias=prescan", "--set", "CCD/PRNU=0"},
      folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const test::CsvTable targets = test::read_csv(folder_.path() / "assessed/analysis/targets.csv");
  for (std::size_t i = 0; i < targets.rows(); ++i) {
    EXPECT_GT(targets.numbers("nsr_1h_smearing_ppm")[i], 0.0);
    EXPECT_EQ(targets.numbers("delta_smearing")[i], 0.0);
    const double z = targets.numbers("delta_residual")[i] / targets.numbers("mag_err")[i];
    if (targets.texts("flags")[i].empty()) {
      EXPECT_LT(std::abs(z), 5.0) << targets.texts("id")[i];
    }
  }
}

}  // namespace
}  // namespace astroid
