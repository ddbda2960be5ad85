// `astroid focal-plane`: maps over the detector from sub-fields of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

class FocalPlane : public testing::Test {
 protected:
  void SetUp() override {
    test::write_small_mission(folder_);
    test::write_pixel_field(folder_.path() / "stars.csv", 240, 900, "");
  }
  test::ProgramResult run(const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"focal-plane", "small.xml",
                                       "--set",       "CCD/Columns=240",
                                       "--set",       "CCD/Rows=240",
                                       "--set",       "Simulation/Exposures=60",
                                       "--set",       "Analysis/Bin=250 s",
                                       "--side",      "70",
                                       "-o",          output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_astroid(arguments, folder_.path());
  }
  test::TemporaryFolder folder_;
};

TEST_F(FocalPlane, MapsWhatTheSubFieldsSay) {
  const test::ProgramResult result = run("map", {});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Maps for magnitude"));
  const test::CsvTable fields = test::read_csv(folder_.path() / "map" / "analysis" / "focal_plane.csv");
  ASSERT_EQ(fields.rows(), 9U);
  const std::vector<double> x = fields.numbers("x");
  EXPECT_EQ(x[0], 39.5);  // the middle of a third of 240 px, as near as 70 px allow
  EXPECT_EQ(x[1], 119.5);
  const std::vector<double> predicted = fields.numbers("nsr_predicted_ppm");
  const std::vector<double> measured = fields.numbers("nsr_measured_ppm");
  const std::vector<double> error = fields.numbers("nsr_measured_ppm_err");
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_GT(predicted[i], 10.0);
    EXPECT_NEAR(measured[i], predicted[i], 5.0 * error[i]) << i;
  }
  const test::CsvTable map = test::read_csv(folder_.path() / "map" / "analysis" / "focal_plane_map.csv");
  EXPECT_EQ(map.rows(), 41U * 41U);
  for (const double value : map.numbers("nsr_predicted_ppm")) ASSERT_TRUE(std::isfinite(value));
  for (const double value : map.numbers("nsr_predicted_ppm_err")) ASSERT_TRUE(value > 0.0);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "map" / "run.json"));
}

TEST_F(FocalPlane, IsTheSameForAnyNumberOfThreads) {
  ASSERT_EQ(run("one", {"--threads", "1", "--across", "2", "--down", "1"}).exit_code, 0);
  ASSERT_EQ(run("three", {"--threads", "3", "--across", "2", "--down", "1"}).exit_code, 0);
  EXPECT_EQ(test::expect_same_products(folder_.path() / "one", folder_.path() / "three", {"analysis"}), 2U);
}

TEST_F(FocalPlane, SaysWhereThereIsNothingToMap) {
  const test::ProgramResult result = run("none", {"--magnitude", "3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("no sub-field has a clean target near it"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "none"));
}

}  // namespace
}  // namespace astroid
