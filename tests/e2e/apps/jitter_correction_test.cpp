// Light curves after jitter correction: the same whoever computes them, and undone where they are analysed again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

class CorrectedLightCurves : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }
  std::filesystem::path assess(const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments{"assess", "small.xml", "-o", name, "--threads", name == "two" ? "2" : "1"};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    const test::ProgramResult run = test::run_astroid(arguments, folder_.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return folder_.path() / name;
  }
  test::TemporaryFolder folder_;
};

TEST_P(CorrectedLightCurves, AreTheSameForAnyNumberOfThreadsAndWhenAnalysedAgain) {
  const std::vector<std::string> settings{std::string("Photometry/JitterCorrection=") + GetParam(),
                                          "Photometry/Knowledge/Attitude=0.01",
                                          "Simulation/Exposures=37",
                                          "Telescope/SimulatedCameras=2",
                                          "Satellite/Drift/YawRate=720",
                                          "Photometry/MaskRefresh=0.003"};
  const std::filesystem::path one = assess("one", settings);
  EXPECT_GE(test::expect_same_products(one, assess("two", settings)), 10U);

  const test::ProgramResult run = test::run_astroid({"analyse", "one", "-o", "again"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const test::CsvTable first = test::read_csv(one / "analysis/targets.csv");
  const test::CsvTable again = test::read_csv(folder_.path() / "again/analysis/targets.csv");
  for (const std::string& name : first.names) {
    // Undone from fluxes in single precision: 6e-8 of the flux, where the correction is some 1e-3.
    if (name == "nsr_1h_simulated_ppm_uncorrected") continue;
    EXPECT_EQ(first.texts(name), again.texts(name)) << name;
  }
  const std::vector<double> before = first.numbers("nsr_1h_simulated_ppm_uncorrected");
  const std::vector<double> undone = again.numbers("nsr_1h_simulated_ppm_uncorrected");
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(undone[i], before[i], 0.1) << i;
}

INSTANTIATE_TEST_SUITE_P(Each, CorrectedLightCurves, testing::Values("known", "centroids"));

TEST_F(CorrectedLightCurves, AgreeWithTheirPredictionBeforeAndAfter) {
  // Jitter twenty times PLATO's: much of the noise of bright stars.
  const std::vector<std::string> jitter{"Simulation/Exposures=400",      "Satellite/Jitter/Yaw=0.76",
                                        "Satellite/Jitter/Pitch=0.76",   "Satellite/Jitter/Roll=0.8",
                                        "Satellite/Jitter/Timescale=25", "CCD/PRNU=0"};
  std::vector<std::string> corrected = jitter;
  corrected.emplace_back("Photometry/JitterCorrection=centroids");
  const test::CsvTable before = test::read_csv(assess("before", jitter) / "analysis/targets.csv");
  const test::CsvTable after = test::read_csv(assess("after", corrected) / "analysis/targets.csv");
  const auto mean_ratio = [](const test::CsvTable& table) {
    const std::vector<double> measured = table.numbers("nsr_exposure_measured");
    const std::vector<double> predicted = table.numbers("nsr_exposure");
    double sum = 0.0;
    for (std::size_t i = 0; i < measured.size(); ++i) sum += measured[i] / predicted[i] / double(measured.size());
    return sum;
  };
  EXPECT_NEAR(mean_ratio(before), 1.0, 4.0 * std::sqrt(0.5 / 200));  // the stars move together, in some 200 ways
  EXPECT_NEAR(mean_ratio(after), 1.0, 4.0 * std::sqrt(0.5 / 400) / 5.0 + 0.02);
  const std::vector<double> raw = after.numbers("nsr_1h_simulated_ppm_uncorrected");
  const std::vector<double> left = after.numbers("nsr_1h_simulated_ppm_measured");
  double most = 0.0;
  for (std::size_t i = 0; i < raw.size(); ++i) most = std::max(most, raw[i] / left[i]);
  EXPECT_GT(most, 1.5) << "a bright star at the edge of a pixel of its mask";
  const std::string page = test::read_file(folder_.path() / "after/report/index.html");
  EXPECT_THAT(page, testing::HasSubstr("motion was taken out of the light curves with the attitude measured"));
}

TEST_F(CorrectedLightCurves, WithoutAStarToMeasureByAreRefused) {
  const test::ProgramResult run =
      test::run_astroid({"assess", "small.xml", "-o", "none", "--set", "Photometry/JitterCorrection=centroids", "--set",
                         "CCD/FullWell=100"},
                        folder_.path());
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_THAT(run.err, testing::HasSubstr("there is no star to measure the attitude by"));
}

}  // namespace
}  // namespace astroid
