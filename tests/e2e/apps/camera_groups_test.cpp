// A mission with groups of cameras from configuration to report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;
using Settings = std::vector<std::string>;

test::ProgramResult run(const test::TemporaryFolder& folder, const std::string& command, const std::string& name,
                        const Settings& settings) {
  std::vector<std::string> arguments{command, "small.xml", "-o", name};
  for (const std::string& setting : settings) {
    arguments.emplace_back("--set");
    arguments.push_back(setting);
  }
  return test::run_astroid(arguments, folder.path());
}

const Settings kTwoGroups{"Telescope/Groups/Cameras=12 12",
                          "Telescope/SimulatedCameras=2",
                          "Telescope/Groups/Roll=0 90",
                          "Telescope/Groups/Stagger=0 12.5",
                          "Telescope/Groups/OffsetX=0 0.4",
                          "Telescope/Groups/Throughput=1 0.8",
                          "Output/Images=all"};

TEST(CameraGroups, ThePresetOfAllCamerasMeasuresTheNoiseThatIsPredicted) {
  const test::TemporaryFolder folder;
  const test::ProgramResult result =
      test::run_astroid({"assess", "plato-groups", "-o", "out", "--threads", "2"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto targets = test::read_csv(folder.path() / "out/analysis/targets.csv");
  const std::vector<double> predicted = targets.numbers("nsr_1h_simulated_within_ppm");
  const std::vector<double> measured = targets.numbers("nsr_1h_simulated_within_ppm_measured");
  const std::vector<double> errors = targets.numbers("nsr_1h_simulated_within_ppm_measured_err");
  double ratio = 0.0;
  double squares = 0.0;
  int stars = 0;
  for (std::size_t i = 0; i < targets.rows(); ++i) {
    if (!(errors[i] > 0.0) || !targets.columns.at("flags")[i].empty()) continue;
    ratio += measured[i] / predicted[i];
    squares += errors[i] * errors[i] / (measured[i] * measured[i]);
    ++stars;
  }
  ratio /= stars;
  std::printf("%d stars: measured / predicted noise within bins %.4f +- %.4f\n", stars, ratio,
              std::sqrt(squares) / stars);
  EXPECT_GT(stars, 100);
  EXPECT_NEAR(ratio, 1.0, 4.0 * std::sqrt(squares) / stars);
  for (int g = 2; g <= 4; ++g)
    EXPECT_TRUE(std::filesystem::exists(folder.path() / ("out/truth/stars_group" + std::to_string(g) + ".csv")));
  for (int c = 1; c <= 4; ++c)
    EXPECT_TRUE(std::filesystem::exists(folder.path() / ("out/images/camera" + std::to_string(c) + "_000000.fits")));
  EXPECT_THAT(test::read_file(folder.path() / "out/plan.txt"), HasSubstr("24 in 4 groups, 4 of them simulated"));
  EXPECT_THAT(test::read_file(folder.path() / "out/run.json"), HasSubstr("stagger_s"));
}

TEST(CameraGroups, SeeTheTargetsThatAllOfThemSee) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  Settings settings = kTwoGroups;
  settings.emplace_back("Telescope/Groups/OffsetY=0 40");  // moves stars off the second detector
  const test::ProgramResult result = run(folder, "assess", "out", settings);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto ids = [&](const std::string& file) {
    const auto table = test::read_csv(folder.path() / file);
    const auto& column = table.columns.at("id");
    std::set<std::string> all;
    for (std::size_t i = 0; i < column.size(); ++i)
      if (!table.columns.contains("target") || table.columns.at("target")[i] == "1") all.insert(column[i]);
    return all;
  };
  const auto first = ids("out/truth/stars.csv");
  const auto second = ids("out/truth/stars_group2.csv");
  std::set<std::string> common;
  for (const std::string& id : first)
    if (second.contains(id)) common.insert(id);
  EXPECT_LT(common.size(), first.size());
  EXPECT_GT(common.size(), 0U);
  EXPECT_EQ(ids("out/analysis/targets.csv"), common);
  EXPECT_THAT(test::read_file(folder.path() / "out/run.json"), HasSubstr("stars are targets in some groups"));
}

TEST(CameraGroups, AnalysedAgainGiveTheSameTables) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(run(folder, "assess", "out", kTwoGroups).exit_code, 0);
  const std::string before = test::read_file(folder.path() / "out/analysis/targets.csv");
  const test::ProgramResult again = test::run_astroid({"analyse", "out"}, folder.path());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(test::read_file(folder.path() / "out/analysis/targets.csv"), before);
}

TEST(CameraGroups, OfAllCamerasGiveTheTablesOfAMissionWithoutGroups) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(run(folder, "assess", "without", {}).exit_code, 0);
  ASSERT_EQ(run(folder, "assess", "with", {"Telescope/Groups/Cameras=24", "Telescope/Groups/Tilt=0"}).exit_code, 0);
  for (const char* file : {"analysis/targets.csv", "analysis/noise_budget.csv", "truth/stars.csv", "plan.txt"}) {
    const auto without_times = [&](const std::string& name) { return test::read_file(folder.path() / name / file); };
    EXPECT_EQ(without_times("with"), without_times("without")) << file;
  }
}

TEST(CameraGroups, AreSimulatedAndMappedOneByOne) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  EXPECT_EQ(run(folder, "simulate", "images", kTwoGroups).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "images/images/camera2_000005.fits"));
  std::vector<std::string> arguments{"focal-plane", "small.xml", "-o",     "map", "--across", "1",
                                     "--down",      "1",         "--side", "100", "--group",  "2"};
  for (const std::string& setting : kTwoGroups) arguments.insert(arguments.end(), {"--set", setting});
  const test::ProgramResult map = test::run_astroid(arguments, folder.path());
  EXPECT_EQ(map.exit_code, 0) << map.err;
  arguments[11] = "3";
  arguments[3] = "no-map";
  const test::ProgramResult refused = test::run_astroid(arguments, folder.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("1 to 2"));
}

}  // namespace
}  // namespace astroid
