// The same field through a CCD and through a CMOS detector, from configuration to report: both reports state the noise
// that is measured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

struct Ratio {
  double value = 0.0, error = 0.0;
  int stars = 0;
};

/// Measured over predicted noise of one exposure, mean over the clean targets of a run.
Ratio noise_ratio(const std::filesystem::path& folder) {
  const auto table = test::read_csv(folder / "analysis/targets.csv");
  Ratio ratio;
  double squares = 0.0;
  const std::vector<double> all_predicted = table.numbers("nsr_exposure");
  const std::vector<double> all_measured = table.numbers("nsr_exposure_measured");
  const std::vector<double> all_errors = table.numbers("nsr_exposure_measured_err");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double predicted = all_predicted[row];
    const double measured = all_measured[row] / predicted;
    const double error = all_errors[row] / predicted;
    if (!std::isfinite(measured) || !(error > 0.0)) continue;  // saturated
    // A plain mean: stars that happen to be quiet state a small error.
    ratio.value += measured;
    squares += error * error / (measured * measured);
    ++ratio.stars;
  }
  ratio.value /= ratio.stars;
  ratio.error = std::sqrt(squares) / ratio.stars;
  return ratio;
}

Ratio assess(const test::TemporaryFolder& folder, const std::string& name, const std::vector<std::string>& settings) {
  std::vector<std::string> arguments{
      "assess", "small.xml", "-o", name, "--set", "Simulation/Exposures=120", "--set", "Satellite/Jitter/model=none"};
  for (const std::string& setting : settings) {
    arguments.emplace_back("--set");
    arguments.push_back(setting);
  }
  const test::ProgramResult run = test::run_astroid(arguments, folder.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / name / "report/index.html"));
  const Ratio ratio = noise_ratio(folder.path() / name);
  std::printf("%-6s %d stars: measured / predicted noise of an exposure %.4f +- %.4f\n", name.c_str(), ratio.stars,
              ratio.value, ratio.error);
  return ratio;
}

TEST(CcdAndCmos, OfTheSameFieldBothMeasureTheNoiseThatIsPredicted) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  const std::vector<std::string> cmos{
      "Simulation/Type=CMOS",   "CCD/FullWell=80000",      "CCD/ReadoutNoise=13",   "CCD/Gain=1.92",
      "CCD/Bias=5000",          "CMOS/Reads=16",           "CMOS/ResetNoise=44",    "CMOS/ColumnNoise=1",
      "CMOS/RowNoise=1",        "CMOS/GainSpread=0.5",     "CMOS/OffsetSpread=100", "CMOS/ReadoutNoiseSpread=0.1",
      "CMOS/Coupling/Side=0.8", "CMOS/Coupling/Corner=0.1"};
  for (const Ratio& ratio : {assess(folder, "ccd", {}), assess(folder, "cmos", cmos)}) {
    EXPECT_GE(ratio.stars, 20);
    EXPECT_LT(std::abs(ratio.value - 1.0), 4.0 * ratio.error);
  }
  const std::string plan = test::read_file(folder.path() / "cmos/plan.txt");
  EXPECT_THAT(plan, testing::HasSubstr("ramp-fit"));
  EXPECT_THAT(plan, testing::HasSubstr("inter-pixel-capacitance"));
}

TEST(CcdAndCmos, APresetWithACmosDetectorRuns) {
  const test::TemporaryFolder folder;
  const test::ProgramResult run =
      test::run_astroid({"assess", "cmos", "-o", "out", "--set", "Simulation/Exposures=24", "--set",
                         "CCD/SubField/columns=120", "--set", "CCD/SubField/rows=120"},
                        folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/report/index.html"));
}

}  // namespace
}  // namespace astroid
