// The commands around a run: plan, budget, field, init, validate, explain, doctor, and the help of each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

class Commands : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }
  std::string said(const std::vector<std::string>& arguments) {
    last_ = test::run_astroid(arguments, folder_.path());
    EXPECT_EQ(last_.exit_code, 0) << last_.err;
    EXPECT_THAT(last_.err, IsEmpty());
    return last_.out;
  }
  test::TemporaryFolder folder_;
  test::ProgramResult last_;
};

TEST_F(Commands, ExplainThemselves) {
  for (const char* command : {"assess", "simulate", "focal-plane", "photometry", "analyse", "plan", "budget", "field",
                              "init", "validate", "explain", "doctor"}) {
    for (const char* flag : {"-h", "--help"})
      EXPECT_THAT(said({command, flag}), AllOf(HasSubstr("Usage: astroid " + std::string(command)), HasSubstr("-h")));
    EXPECT_THAT(said({"-h"}), HasSubstr(command));
  }
  EXPECT_THAT(said({"--version"}), MatchesRegex("astroid [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(Commands, PlanSaysWhatWouldBeComputedAndWhyAsTextAndAsJson) {
  const std::string text = said({"plan", "small.xml"});
  EXPECT_THAT(text, AllOf(HasSubstr("full frame of 100 x 100 px"), HasSubstr("25 of them targets"),
                          HasSubstr("on  photon-noise"), HasSubstr("off full-well"), HasSubstr("ms per exposure")));
  const auto plan = nlohmann::json::parse(said({"plan", "small.xml", "--json"}));
  bool photon_noise = false;
  for (const auto& effect : plan.at("effects"))
    photon_noise = photon_noise || effect.dump().find("photon-noise") != std::string::npos;
  EXPECT_TRUE(photon_noise);
  EXPECT_THAT(said({"plan", "small.xml", "--set", "CCD/PRNU=0"}), HasSubstr("off prnu"));
}

// SCIENCE: an isolated star on a pixel's centre, sigma 0.6 px, 945 e- of known background, 50.2 e- readout noise, 7.2
// e- of quantisation; the numbers come from an independent program.
TEST_F(Commands, BudgetReproducesTheNoiseOfTheOptimalMask) {
  const std::string table = said({"budget",
                                  "plato",
                                  "--analytic",
                                  "--from",
                                  "10",
                                  "--to",
                                  "12",
                                  "--step",
                                  "1",
                                  "--set",
                                  "CCD/Gain=24.94153",
                                  "--set",
                                  "Photometry/Background=known",
                                  "--set",
                                  "CCD/PRNU=0",
                                  "--set",
                                  "CCD/DarkCurrent=0",
                                  "--set",
                                  "Satellite/Jitter/model=none",
                                  "-o",
                                  "budget.csv"});
  // Far below the second that simulating would take; mostly the start of the program, on whatever machine.
  EXPECT_LT(last_.seconds, 2.0);
  const test::CsvTable csv = test::read_csv(folder_.path() / "budget.csv");
  const std::vector<double> nsr{1.731782e-3, 2.906516e-3, 5.195210e-3};
  const std::vector<double> nsr_1h{29.4582, 49.4408, 88.3723};
  const std::vector<double> flux{371722.881, 147985.544, 58914.106};
  ASSERT_EQ(csv.rows(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(csv.numbers("mag")[i], 10.0 + static_cast<double>(i));
    EXPECT_EQ(csv.texts("mask_pixels")[i], "9");
    EXPECT_NEAR(csv.numbers("enclosed_fraction")[i], 0.975316, 5e-7);
    EXPECT_NEAR(csv.numbers("electrons")[i], flux[i], 5e-4);
    EXPECT_NEAR(csv.numbers("nsr_exposure")[i] / nsr[i], 1.0, 1e-6);
    EXPECT_NEAR(csv.numbers("nsr_1h_ppm")[i], nsr_1h[i], 6e-5);
  }
  EXPECT_THAT(table, AllOf(HasSubstr("in 1 h with 24 camera"), HasSubstr("1.731782e-03"), HasSubstr("2.906516e-03"),
                           HasSubstr("5.195210e-03"), HasSubstr("0.975316")));
}

TEST_F(Commands, FieldMakesAFieldAndExtendsItAndARunUsesIt) {
  const std::vector<std::string> request{"field",    "--ra", "95.3104",  "--dec", "-47.8869", "--radius", "0.3",
                                         "--number", "60",   "--bright", "8",     "--faint",  "12"};
  auto with_output = [&](const char* name) {
    std::vector<std::string> arguments = request;
    arguments.insert(arguments.end(), {"--passband", "P", "-o", name});
    return arguments;
  };
  EXPECT_THAT(said(with_output("field.csv")), HasSubstr("60 stars: field.csv"));
  said(with_output("again.csv"));
  EXPECT_EQ(test::read_file(folder_.path() / "field.csv"), test::read_file(folder_.path() / "again.csv"));

  EXPECT_THAT(said({"field", "--extend", "field.csv", "--ra", "95.3104", "--dec", "-47.8869", "--radius", "0.3",
                    "--faint", "13.5", "--slope", "0.35", "--complete-to", "12", "--passband", "P", "-o", "deep.csv"}),
              HasSubstr("stars added down to 13.50"));
  EXPECT_GT(test::lines_of(test::read_file(folder_.path() / "deep.csv")).size(), 100U);

  for (const char* catalogue : {"field.csv", "deep.csv"}) {
    const std::string verdict =
        said({"assess", "small.xml", "--set", std::string("StellarField/Catalogue=") + catalogue, "-o",
              std::string("run-") + catalogue});
    EXPECT_EQ(test::lines_of(verdict).size(), 3U) << verdict;
  }
  const auto stars = [&](const char* run) { return test::read_csv(folder_.path() / run / "truth/stars.csv").rows(); };
  EXPECT_GT(stars("run-field.csv"), 10U);
  EXPECT_GT(stars("run-deep.csv"), stars("run-field.csv"));
}

TEST_F(Commands, InitWritesAPresetThatIsValid) {
  for (const std::string name : {"plato", "plato-week", "plato-groups", "cmos"}) {
    const std::string file = name + ".xml";
    EXPECT_THAT(said({"init", name}), HasSubstr("astroid assess " + file));
    EXPECT_EQ(test::read_file(folder_.path() / file), test::read_file(test::source_dir() / "apps/missions" / file));
    EXPECT_THAT(said({"validate", file}), HasSubstr(file + ": valid"));
    EXPECT_THAT(said({"validate", name}), HasSubstr("valid"));
  }
  EXPECT_THAT(said({"validate", "small.xml"}), HasSubstr("valid"));
}

TEST_F(Commands, EveryStarOfTheWeekIsATarget) {
  EXPECT_THAT(said({"plan", "plato-week"}),
              AllOf(HasSubstr("480 x 480 px"), HasSubstr("32240 on or next to the detector, 32240 of them targets"),
                    HasSubstr("for 24192 exposures")));
}

TEST_F(Commands, ExplainTellsUnitRangeAndDefault) {
  EXPECT_THAT(said({"explain", "CCD/Gain"}),
              AllOf(HasSubstr("e-/ADU"), HasSubstr("range"), HasSubstr("default"), HasSubstr("example")));
  EXPECT_THAT(said({"explain"}), AllOf(HasSubstr("Simulation/Seed"), HasSubstr("Output/Images")));
  // Every parameter of the list can be explained.
  std::istringstream list(said({"explain"}));
  std::size_t explained = 0;
  for (std::string line; std::getline(list, line);) {
    const std::string name = line.substr(0, line.find(' '));
    if (name.find('/') == std::string::npos) continue;
    constexpr std::size_t kEvery = 9;  // each is a start of the program
    if (explained++ % kEvery != 0) continue;
    EXPECT_THAT(said({"explain", name}), HasSubstr(name));
  }
  EXPECT_GT(explained, 50U);
}

TEST_F(Commands, DoctorTellsVersionsAndWherePresetsAre) {
  const test::ProgramResult run = test::run_astroid({"doctor"}, folder_.path());
  EXPECT_THAT(run.out, AllOf(HasSubstr("CFITSIO"), HasSubstr("WCSLIB"), HasSubstr("preset plato")));
  EXPECT_EQ(run.exit_code, test::has_program("gnuplot") ? 0 : 3) << "gnuplot draws the figures";
}

TEST_F(Commands, VerboseSaysWhereTheTimeWent) {
  const test::ProgramResult run = test::run_astroid({"simulate", "small.xml", "-o", "result", "-v"}, folder_.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("simulate"), HasSubstr("images")));
}

}  // namespace
}  // namespace astroid
