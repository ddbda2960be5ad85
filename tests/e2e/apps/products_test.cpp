// What a run leaves: every file of the contract, with true checksums, and nothing else said than the result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "astroid/core/product_folder.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::StartsWith;

/// Checks run.json against the files of a run.
void expect_true_checksums(const std::filesystem::path& folder) {
  const auto record = nlohmann::json::parse(test::read_file(folder / "run.json"));
  std::vector<std::string> listed{"run.json"};
  for (const auto& product : record.at("products")) {
    const std::string path = product.at("path");
    listed.push_back(path);
    EXPECT_EQ(product.at("sha256"), sha256_of_file(folder / path)) << path;
    EXPECT_EQ(product.at("bytes"), std::filesystem::file_size(folder / path)) << path;
  }
  std::ranges::sort(listed);
  EXPECT_EQ(listed, test::files_below(folder)) << "run.json must list what is there";
}

TEST(ProductsOfAnAssessment, AreAllThereWithTrueChecksumsAndATwoLineVerdict) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  const test::ProgramResult run = test::run_astroid({"assess", "small.xml", "-o", "result"}, folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty()) << "nothing is to be said on standard error when it is no terminal";

  const std::vector<std::string> said = test::lines_of(run.out);
  ASSERT_EQ(said.size(), 3U) << run.out;
  EXPECT_THAT(said[0], HasSubstr("25 unsaturated targets, mag 8.5"));
  EXPECT_THAT(said[1], HasSubstr("noise at mag 11 in 50 s with 24 cameras"));
  EXPECT_EQ(said[2], "Report: result/report/index.html");

  const std::filesystem::path result = folder.path() / "result";
  const std::vector<std::string> files = test::files_below(result);
  EXPECT_THAT(
      files,
      IsSupersetOf({"run.json", "config.xml", "plan.json", "plan.txt", "truth/stars.csv", "images/camera1_000000.fits",
                    "photometry/sources.csv", "photometry/lightcurves.fits", "analysis/targets.csv",
                    "analysis/noise_vs_magnitude.csv", "analysis/magnitude_recovery.csv", "analysis/contamination.csv",
                    "analysis/noise_budget.csv", "report/index.html", "report/columns.md"}));
  for (const std::string& file : files) {
    EXPECT_THAT(file, Not(testing::EndsWith(".partial")));
    EXPECT_GT(std::filesystem::file_size(result / file), 0U) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "result.partial"));
  expect_true_checksums(result);

  EXPECT_EQ(test::read_csv(result / "truth/stars.csv").rows(), 25U);
  EXPECT_EQ(test::read_csv(result / "photometry/sources.csv").rows(), 25U);
  EXPECT_EQ(test::read_csv(result / "analysis/targets.csv").rows(), 25U);
}

TEST(ProductsOfAnAssessment, SayHowTheyWereMade) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  const std::vector<std::string> arguments{"assess", "small.xml", "-o",   "result", "--threads",
                                           "2",      "--seed",    "1234", "--set",  "CCD/Bias=500"};
  const test::ProgramResult run = test::run_astroid(arguments, folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto record = nlohmann::json::parse(test::read_file(folder.path() / "result/run.json"));
  std::vector<std::string> command = record.at("command_line");
  ASSERT_EQ(command.size(), arguments.size() + 1);
  EXPECT_EQ(std::vector<std::string>(command.begin() + 1, command.end()), arguments);
  EXPECT_EQ(record.at("seed"), 1234);
  EXPECT_EQ(record.at("threads"), 2);
  EXPECT_EQ(record.at("exposures"), 6);
  EXPECT_EQ(record.at("targets"), 25);
  EXPECT_TRUE(record.at("peak_memory_bytes").is_number_integer());
  for (const char* key : {"version", "host", "components", "timings_seconds", "effects_cpu_seconds", "warnings"})
    EXPECT_TRUE(record.contains(key)) << key;
  const std::string configuration = test::read_file(folder.path() / "result/config.xml");
  EXPECT_THAT(configuration, HasSubstr("--set"));
  EXPECT_THAT(configuration, HasSubstr("small.xml:"));
  EXPECT_THAT(configuration, HasSubstr("default"));
}

TEST(ProductsOfAnAssessment, ComeBackFromTheConfigurationThatTheRunWrote) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(test::run_astroid({"assess", "small.xml", "-o", "first", "--seed", "99"}, folder.path()).exit_code, 0);
  const test::ProgramResult again = test::run_astroid({"assess", "first/config.xml", "-o", "second"}, folder.path());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const char* file : {"truth/stars.csv", "images/camera1_000000.fits", "photometry/lightcurves.fits",
                           "photometry/sources.csv", "analysis/targets.csv"})
    EXPECT_EQ(sha256_of_file(folder.path() / "first" / file), sha256_of_file(folder.path() / "second" / file)) << file;
}

TEST(ProductsOfAnAssessment, AreReplacedOnlyWithOverwrite) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(test::run_astroid({"assess", "small.xml", "-o", "result"}, folder.path()).exit_code, 0);
  const std::string before = sha256_of_file(folder.path() / "result/run.json");

  const test::ProgramResult refused =
      test::run_astroid({"assess", "small.xml", "-o", "result", "--seed", "8"}, folder.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--overwrite"));
  EXPECT_EQ(sha256_of_file(folder.path() / "result/run.json"), before);

  const test::ProgramResult replaced =
      test::run_astroid({"assess", "small.xml", "-o", "result", "--seed", "8", "--overwrite"}, folder.path());
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_NE(sha256_of_file(folder.path() / "result/run.json"), before);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "result.partial"));
  expect_true_checksums(folder.path() / "result");
}

TEST(ProductsOfAnAnalysis, AreTheSameAsThoseOfTheRunItself) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(test::run_astroid({"assess", "small.xml", "-o", "result"}, folder.path()).exit_code, 0);
  const test::ProgramResult elsewhere = test::run_astroid({"analyse", "result", "-o", "again"}, folder.path());
  ASSERT_EQ(elsewhere.exit_code, 0) << elsewhere.err;
  EXPECT_THAT(elsewhere.out, HasSubstr("Report: again/report/index.html"));
  std::size_t compared = 0;
  for (const std::string& file : test::files_below(folder.path() / "result")) {
    const bool of_analysis =
        file.starts_with("analysis/") || file == "photometry/sources.csv" || file == "report/columns.md";
    if (!of_analysis) continue;
    EXPECT_EQ(sha256_of_file(folder.path() / "result" / file), sha256_of_file(folder.path() / "again" / file)) << file;
    ++compared;
  }
  EXPECT_EQ(compared, 7U);
}

TEST(ProductsOfAnAnalysis, ShowTheImageAndTheLightCurvesOfTheRunAgain) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(test::run_astroid({"assess", "small.xml", "-o", "result"}, folder.path()).exit_code, 0);
  ASSERT_EQ(test::run_astroid({"analyse", "result", "-o", "again"}, folder.path()).exit_code, 0);
  // Up to the table of parameters, whose origins are now lines of the run's config.xml.
  const auto results = [&](const char* name) {
    const std::string page = test::read_file(folder.path() / name / "report/index.html");
    EXPECT_NE(page.find("Simulation/Type"), std::string::npos);
    return page.substr(0, page.find("Simulation/Type"));
  };
  EXPECT_TRUE(results("result") == results("again")) << "the reports differ";
  EXPECT_EQ(sha256_of_file(folder.path() / "result/report/figures/image.csv"),
            sha256_of_file(folder.path() / "again/report/figures/image.csv"));
}

TEST(ProductsOfAnAnalysis, WithAnotherBinReplaceThoseOfTheRunAndTheirChecksums) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  ASSERT_EQ(test::run_astroid({"assess", "small.xml", "-o", "result"}, folder.path()).exit_code, 0);
  const std::string before = sha256_of_file(folder.path() / "result/analysis/targets.csv");
  const test::ProgramResult run = test::run_astroid({"analyse", "result", "--set", "Analysis/Bin=75"}, folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("in 75 s"));
  EXPECT_NE(sha256_of_file(folder.path() / "result/analysis/targets.csv"), before);
  expect_true_checksums(folder.path() / "result");

  const test::ProgramResult refused =
      test::run_astroid({"analyse", "result", "--set", "CCD/Gain=2", "-o", "other"}, folder.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("would need the exposures again"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "other"));
}

TEST(ProductsOfASimulation, AreImagesAndTruth) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  const test::ProgramResult run =
      test::run_astroid({"simulate", "small.xml", "-o", "result", "--set", "Output/Images=every 2"}, folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  EXPECT_THAT(run.out, StartsWith("3 image files"));
  EXPECT_EQ(
      test::files_below(folder.path() / "result"),
      (std::vector<std::string>{"config.xml", "images/camera1_000000.fits", "images/camera1_000002.fits",
                                "images/camera1_000004.fits", "plan.json", "plan.txt", "run.json", "truth/stars.csv"}));
  expect_true_checksums(folder.path() / "result");
}

}  // namespace
}  // namespace astroid
