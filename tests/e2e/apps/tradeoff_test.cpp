// The command that shows what accuracy costs: every sweep is there, errors keep what is promised, and the advice can be
// pasted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "astroid/core/fits_writer.hpp"
#include "astroid/test/psf_table.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

class Tradeoff : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }

  test::CsvTable run(std::vector<std::string> more) {
    std::vector<std::string> arguments{"tradeoff", "small.xml",   "-o", "t",          "--seconds",
                                       "0.002",    "--exposures", "8",  "--overwrite"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    result_ = test::run_astroid(arguments, folder_.path());
    EXPECT_EQ(result_.exit_code, 0) << result_.err;
    return test::read_csv(folder_.path() / "t/analysis/tradeoff.csv");
  }
  test::TemporaryFolder folder_;
  test::ProgramResult result_;
};

TEST_F(Tradeoff, OfAGaussianHasTheExactRendererOnItsFront) {
  const test::CsvTable table = run({});
  const auto& sweeps = table.columns.at("sweep");
  EXPECT_EQ(std::set<std::string>(sweeps.begin(), sweeps.end()),
            (std::set<std::string>{"renderer", "accuracy", "photometry", "effect", "series"}));
  const auto errors = table.numbers("error_rms_ppm");
  const auto pareto = table.numbers("pareto");
  const auto chosen = table.numbers("chosen");
  int planned = 0;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (sweeps[i] == "renderer" && chosen[i] == 1.0) {
      ++planned;
      EXPECT_EQ(pareto[i], 1.0);
      EXPECT_LT(errors[i], 1e-6);
    }
    if (table.columns.at("setting")[i] == "midpoint 8") {
      EXPECT_NEAR(errors[i], 441.0, 0.2 * 441.0);
    }
  }
  EXPECT_EQ(planned, 1);
  EXPECT_THAT(result_.out, HasSubstr("Recommended: --set Simulation/Accuracy="));
  EXPECT_THAT(test::read_file(folder_.path() / "t/report/tradeoff.txt"), HasSubstr("Pareto front"));
}

TEST_F(Tradeoff, OfATableKeepsEveryAccuracyThatIsAskedFor) {
  constexpr int kSamplesPerPixel = 8;
  const PsfTable psf = test::gaussian_psf_table(0.7, kSamplesPerPixel, 5.0);
  FitsWriter fits(folder_.path() / "psf.fits");
  fits.begin_image(FitsNumber::kFloat64, {psf.samples.nx(), psf.samples.ny()});
  fits.card({"SUBPIX", kSamplesPerPixel});
  fits.write_pixels(0, psf.samples.pixels());
  fits.commit();
  const test::CsvTable table = run({"--set", "PSF/Model=table", "--set", "PSF/File=psf.fits"});
  const auto of_promise = table.numbers("of_promise");
  const auto errors = table.numbers("error_max_ppm");
  const auto operations = table.numbers("operations");
  const auto value = table.numbers("value");
  const auto chosen = table.numbers("chosen");
  const auto& sweeps = table.columns.at("sweep");
  int kept = 0;
  std::map<double, double> work;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (chosen[i] == 1.0 && sweeps[i] == "renderer") continue;
    if (!std::isfinite(value[i]) || (sweeps[i] != "accuracy" && !table.columns.at("setting")[i].starts_with("prf ")))
      continue;
    EXPECT_LE(of_promise[i], 1.0) << table.columns.at("setting")[i];
    EXPECT_TRUE(std::isfinite(errors[i]));
    ++kept;
    if (sweeps[i] == "accuracy") work[value[i]] = operations[i];
  }
  EXPECT_EQ(kept, 14);
  ASSERT_EQ(work.size(), 7U);
  double before = INFINITY;
  for (const auto& [ppm, count] : work) {
    EXPECT_LE(count, before) << ppm;
    before = count;
  }
  EXPECT_LT(work.rbegin()->second, work.begin()->second);
}

}  // namespace
}  // namespace astroid
