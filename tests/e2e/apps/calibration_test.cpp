// `astroid doctor --calibrate`: afterwards plans know how long an exposure takes on this machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

class Calibration : public testing::Test {
 protected:
  void SetUp() override {
    test::write_small_mission(folder_);
    test::write_pixel_field(folder_.path() / "stars.csv", 512, 2000, "");
    costs_ = folder_.path() / "costs.json";
  }
  test::ProgramResult run(const std::vector<std::string>& arguments) {
    return test::run_astroid_through({"env", "ASTROID_COSTS=" + costs_.string()}, arguments, folder_.path());
  }
  test::TemporaryFolder folder_;
  std::filesystem::path costs_;
};

/// Processes that want a processor, for each processor there is.
double load_per_processor() {
  double load = 0.0;
  std::ifstream("/proc/loadavg") >> load;
  return load / std::max(1U, std::thread::hardware_concurrency());
}

TEST_F(Calibration, MakesPlansPredictTheTimeOfEachEffect) {
  constexpr double kBusy = 1.6;
  if (load_per_processor() > kBusy) GTEST_SKIP() << "the machine is too busy for times of microseconds to mean a thing";
  constexpr double kFactor = 1.5;
  std::string worst;
  // Whoever else uses the machine spoils a measurement now and then, not several in a row.
  for (int attempt = 0; attempt < 4; ++attempt) {
    const test::ProgramResult doctor = run({"doctor", "--calibrate"});
    ASSERT_EQ(doctor.exit_code, 0) << doctor.err;
    ASSERT_TRUE(std::filesystem::exists(costs_));
    const test::ProgramResult assess =
        run({"simulate", "small.xml", "--set", "CCD/Columns=512", "--set", "CCD/Rows=512", "--set",
             "Simulation/Exposures=80", "--set", "Output/Images=none", "--threads", "1", "--overwrite", "-o", "run"});
    ASSERT_EQ(assess.exit_code, 0) << assess.err;
    const auto record = nlohmann::json::parse(test::read_file(folder_.path() / "run" / "run.json"));
    const auto& measured = record.at("effects_cpu_seconds");
    double all = 0.0;
    for (const auto& [effect, seconds] : measured.items()) all += seconds.get<double>();
    worst.clear();
    for (const auto& [effect, predicted] : record.at("effects_predicted_seconds").items()) {
      const double seconds = measured.at(effect).get<double>();
      if (seconds < 0.05 * all) continue;  // a few microseconds a strip
      const double ratio = predicted.get<double>() / seconds;
      std::printf("%-16s predicted / measured %.2f\n", effect.c_str(), ratio);
      if (ratio > kFactor || ratio < 1.0 / kFactor) worst += effect + " ";
    }
    if (worst.empty()) break;
  }
  EXPECT_EQ(worst, "");
}

TEST_F(Calibration, OfAnotherMachineOrBrokenIsNoConcern) {
  const std::string usual = run({"plan", "small.xml"}).out;
  for (const char* content : {"", "{", "[1,2]", R"({"version":"0.1.0","processor":"another","factors":{"stars":9}})",
                              R"({"version":3,"processor":[],"factors":7})"}) {
    std::ofstream(costs_) << content;
    const test::ProgramResult plan = run({"plan", "small.xml"});
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    EXPECT_EQ(plan.out, usual) << content;
  }
}

TEST_F(Calibration, IsOffered) {
  EXPECT_THAT(run({"doctor"}).out, HasSubstr("astroid doctor --calibrate"));
}

}  // namespace
}  // namespace astroid
