// Cotrending in a run: a drift of the gain that all stars have is found and taken out; noise alone has no trends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/fits_reader.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

class CotrendedRun : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }
  std::filesystem::path assess(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"assess", "small.xml", "-o", name, "--threads", name == "two" ? "2" : "1"};
    std::vector<std::string> settings{"Simulation/Exposures=160", "Satellite/Jitter/Yaw=0", "Satellite/Jitter/Pitch=0",
                                      "Satellite/Jitter/Roll=0", "Photometry/Cotrending=3"};
    settings.insert(settings.end(), more.begin(), more.end());
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    const test::ProgramResult run = test::run_astroid(arguments, folder_.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return folder_.path() / name;
  }
  test::TemporaryFolder folder_;
};

TEST_F(CotrendedRun, LosesTheDriftThatAllStarsHave) {
  const std::vector<std::string> drift{"CCD/Electronics/GainDrift=1", "CCD/Electronics/DriftPeriod=1600"};
  const std::filesystem::path one = assess("one", drift);
  EXPECT_GE(test::expect_same_products(one, assess("two", drift)), 10U);
  const test::CsvTable targets = test::read_csv(one / "analysis/targets.csv");
  const test::CsvTable quiet = test::read_csv(assess("quiet", {}) / "analysis/targets.csv");
  const std::vector<double> before = targets.numbers("nsr_1h_simulated_ppm_measured");
  const std::vector<double> after = targets.numbers("nsr_1h_simulated_ppm_cotrended");
  const std::vector<double> without = quiet.numbers("nsr_1h_simulated_ppm");
  EXPECT_GT(before[0], 5.0 * without[0]) << "7000 ppm of drift, of which the prediction of a quiet run knows nothing";
  double ratio = 0.0;
  for (std::size_t t = 0; t < after.size(); ++t) ratio += after[t] / without[t] / static_cast<double>(after.size());
  // 25 stars of 78 degrees of freedom; a trend found in 25 stars has 1/25 of their noise in it, for which 1 % is left.
  EXPECT_NEAR(ratio, 1.0, 4.0 * std::sqrt(0.5 / (25 * 78)) + 0.01);

  const FitsReader fits(one / "photometry/cotrending.fits");
  const int trends = fits.find_unit("TRENDS").value();
  EXPECT_EQ(fits.units()[static_cast<std::size_t>(trends) - 1].rows, 80);
  EXPECT_TRUE(fits.find_column(trends, "TREND1").has_value());
  EXPECT_FALSE(fits.find_column(trends, "TREND2").has_value()) << "there is but one drift";
  const int table = fits.find_unit("TARGETS").value();
  const std::vector<double> amplitude = fits.read_numbers(table, fits.find_column(table, "AMPLITUDE1").value());
  const std::vector<double> left = fits.read_numbers(table, fits.find_column(table, "RMS_AFTER").value());
  for (std::size_t t = 0; t < amplitude.size(); ++t)
    EXPECT_NEAR(std::abs(amplitude[t]), 0.01 / std::sqrt(2.0), 4.0 * left[t] / std::sqrt(80.0))
        << "rms of a sinusoid of 1 %";

  const test::ProgramResult run = test::run_astroid({"analyse", "one", "-o", "again"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* product : {"analysis/targets.csv", "photometry/cotrending.fits"})
    EXPECT_EQ(test::read_file(one / product), test::read_file(folder_.path() / "again" / product)) << product;
  EXPECT_THAT(test::read_file(one / "report/index.html"), testing::HasSubstr("bin means of 25 targets have 1 trend"));
}

TEST_F(CotrendedRun, IsWhatItWasWhereStarsHaveNothingInCommon) {
  const std::filesystem::path run = assess("noise", {});
  const test::CsvTable targets = test::read_csv(run / "analysis/targets.csv");
  const std::vector<double> before = targets.numbers("nsr_1h_simulated_ppm_measured");
  const std::vector<double> after = targets.numbers("nsr_1h_simulated_ppm_cotrended");
  for (std::size_t t = 0; t < before.size(); ++t) EXPECT_NEAR(after[t], before[t], 1e-3 * before[t]) << t;
  EXPECT_THAT(test::read_file(run / "report/index.html"), testing::HasSubstr("cotrending found nothing"));
}

}  // namespace
}  // namespace astroid
