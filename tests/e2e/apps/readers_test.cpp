// Programs of another make read what a run wrote, and find in it what was put there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "astroid/test/python.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

std::filesystem::path script(const char* name) {
  return test::source_dir() / "tests" / "e2e" / "apps" / name;
}

class Readers : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }
  void need(const std::string& program) {
    if (!test::has_program(program)) GTEST_SKIP() << program << " is not installed";
  }
  /// An assessment in `result`.
  void assess(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"assess", "small.xml", "-o", "result"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::ProgramResult run = test::run_astroid(arguments, folder_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Readers, FitsverifyAcceptsImagesWindowsStepsAndLightCurves) {
  need("fitsverify");
  if (IsSkipped()) return;
  assess({"--dump-steps", "1"});
  ASSERT_EQ(
      test::run_astroid({"simulate", "small.xml", "-o", "windows", "--set", "CCD/Window=12"}, folder_.path()).exit_code,
      0);
  ASSERT_EQ(test::run_astroid({"analyse", "result", "--export", "star3", "-o", "single"}, folder_.path()).exit_code, 0);
  std::size_t verified = 0;
  for (const std::string& file : test::files_below(folder_.path())) {
    if (!file.ends_with(".fits")) continue;
    const test::ProgramResult verdict = test::run_program({"fitsverify", "-q", file}, folder_.path());
    EXPECT_EQ(verdict.exit_code, 0) << verdict.out;
    EXPECT_THAT(verdict.out, HasSubstr("OK")) << file;
    ++verified;
  }
  EXPECT_EQ(verified, 1U + 1U + 9U + 1U + 1U) << "image, light curves, steps, windows, single light curve";
}

TEST_F(Readers, AstropyPutsTrueStarsAtTruePixelsAndReadsImagesAndLightCurves) {
  if (!test::python_has({"astropy", "numpy"})) GTEST_SKIP() << "python3-astropy is not installed";
  assess({"--set", "Satellite/Pointing/Roll=33", "--set", "CCD/SubField/x=5", "--set", "CCD/SubField/y=3", "--set",
          "CCD/SubField/columns=90", "--set", "CCD/SubField/rows=95"});
  const std::string out = test::run_python(script("read_products.py"), {(folder_.path() / "result").string()});
  EXPECT_EQ(out, "all is well\n");
}

TEST_F(Readers, AstropyReadsAnExportedLightCurveByTheRulesOfLightkurve) {
  if (!test::python_has({"astropy", "numpy"})) GTEST_SKIP() << "python3-astropy is not installed";
  assess();
  const test::ProgramResult run = test::run_astroid({"analyse", "result", "--export", "star3,star20"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "result/photometry/lightcurve_star3.fits\nresult/photometry/lightcurve_star20.fits\n");
  for (const char* id : {"star3", "star20"}) {
    const std::string out =
        test::run_python(script("read_light_curve.py"),
                         {(folder_.path() / "result/photometry" / ("lightcurve_" + std::string(id) + ".fits")).string(),
                          (folder_.path() / "result/photometry/lightcurves.fits").string(), id});
    EXPECT_EQ(out, "all is well\n");
  }
}

TEST_F(Readers, StiltsReadsEveryTable) {
  need("stilts");
  if (IsSkipped()) return;
  assess();
  // One start of its Java machine for all tables.
  std::vector<std::pair<std::string, std::string>> tables;
  for (const std::string& file : test::files_below(folder_.path() / "result"))
    if (file.ends_with(".csv") && !file.starts_with("report/")) tables.emplace_back(file, "csv");
  EXPECT_GE(tables.size(), 7U);
  tables.emplace_back("photometry/lightcurves.fits#STARS", "fits");
  std::vector<std::string> command{"stilts", "tmultin", "nin=" + std::to_string(tables.size()), "out=all.fits"};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string n = std::to_string(i + 1);
    command.push_back("in" + n + "=result/" + tables[i].first);
    command.push_back("ifmt" + n + "=" + tables[i].second);
  }
  const test::ProgramResult run = test::run_program(command, folder_.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(Readers, XmllintAcceptsConfigurationsByTheSchemaAndRefusesAMisspeltName) {
  need("xmllint");
  if (IsSkipped()) return;
  assess({"--seed", "3"});
  const test::ProgramResult schema = test::run_astroid({"validate", "--schema"}, folder_.path());
  ASSERT_EQ(schema.exit_code, 0);
  folder_.write("astroid.xsd", schema.out);
  const std::string preset = (test::source_dir() / "apps/missions/plato.xml").string();
  const auto lint = [&](const std::string& file) {
    return test::run_program({"xmllint", "--noout", "--nonet", "--schema", "astroid.xsd", file}, folder_.path());
  };
  for (const std::string& file : {std::string("small.xml"), std::string("result/config.xml"), preset}) {
    const test::ProgramResult run = lint(file);
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  std::string text = test::read_file(folder_.path() / "small.xml");
  text.replace(text.find("<Bias"), 5, "<Bais").replace(text.find("</Bias"), 6, "</Bais");
  folder_.write("misspelt.xml", text);
  EXPECT_NE(lint("misspelt.xml").exit_code, 0);
}

TEST_F(Readers, SExtractorFindsTheStarsOfAnImageWhereTheyAre) {
  need("source-extractor");
  if (IsSkipped()) return;
  assess();
  folder_.write("columns.param", "XWIN_IMAGE\nYWIN_IMAGE\nFLUX_AUTO\nFLAGS\n");
  folder_.write("none.conv", "CONV NORM\n0 0 0\n0 1 0\n0 0 0\n");
  folder_.write("run.sex",
                "CATALOG_NAME found.txt\nCATALOG_TYPE ASCII\nPARAMETERS_NAME columns.param\nFILTER N\n"
                "FILTER_NAME none.conv\nDETECT_MINAREA 4\nDETECT_THRESH 5\nANALYSIS_THRESH 5\nPHOT_AUTOPARAMS 2.5,3.5\n"
                "BACK_SIZE 32\nCHECKIMAGE_TYPE NONE\nVERBOSE_TYPE QUIET\n");
  const test::ProgramResult run =
      test::run_program({"source-extractor", "result/images/camera1_000000.fits", "-c", "run.sex"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream found(test::read_file(folder_.path() / "found.txt"));
  std::vector<std::pair<double, double>> sources;
  for (double x = 0.0, y = 0.0, flux = 0.0, flags = 0.0; found >> x >> y >> flux >> flags;)
    sources.emplace_back(x - 1.0, y - 1.0);  // it counts from 1
  EXPECT_EQ(sources.size(), 25U);
  const test::CsvTable truth = test::read_csv(folder_.path() / "result/truth/stars.csv");
  const auto x = truth.numbers("x");
  const auto y = truth.numbers("y");
  const auto electrons = truth.numbers("electrons");
  for (std::size_t i = 0; i < truth.rows(); ++i) {
    double nearest = 99.0;
    for (const auto& [sx, sy] : sources) nearest = std::min(nearest, std::hypot(sx - x[i], sy - y[i]));
    // The centroid of an undersampled star depends on its place in the pixel, by some hundredths; 1 % PRNU and the
    // noise (some 60 e- per pixel) add less.
    EXPECT_LT(nearest, 0.1 + 200.0 / electrons[i]) << truth.texts("id")[i];
  }
}

TEST_F(Readers, SepMeasuresTheSameApertureFluxes) {
  if (!test::python_has({"astropy", "numpy", "sep"})) GTEST_SKIP() << "python3-sep or -astropy is not installed";
  assess();
  const test::ProgramResult run =
      test::run_astroid({"photometry", "result/images/camera1_000000.fits", "--catalogue", "result/truth/stars.csv",
                         "--method", "aperture", "--radius", "3.3", "--background", "0", "-o", "sources.csv"},
                        folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string out =
      test::run_python(script("aperture_sums.py"), {(folder_.path() / "result/images/camera1_000000.fits").string(),
                                                    (folder_.path() / "sources.csv").string(), "3.3"});
  EXPECT_EQ(out, "all is well\n");
}

}  // namespace
}  // namespace astroid
