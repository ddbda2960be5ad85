// A real field: 32240 stars to magnitude 15 on 480 x 480 px, as many as in the paper that started the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

TEST(RealField, Of32240StarsIsAssessedFromCatalogueToReport) {
  const auto catalogue = test::shared_data("catalogues/platosim_pic11_field_V15.csv");
  if (!catalogue) GTEST_SKIP() << "the folder of real data is not there";
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  const test::ProgramResult run = test::run_astroid(
      {"assess", "small.xml", "-o", "result", "--set", "StellarField/Catalogue=" + catalogue->string(), "--set",
       "Satellite/Pointing/RA=180", "--set", "Satellite/Pointing/Dec=-70", "--set", "CCD/Columns=480", "--set",
       "CCD/Rows=480", "--set", "Simulation/Exposures=2", "--set", "Photometry/TargetLimit=12"},
      folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(test::lines_of(run.out).size(), 3U) << run.out;
  const test::CsvTable truth = test::read_csv(folder.path() / "result/truth/stars.csv");
  EXPECT_GT(truth.rows(), 25000U);
  EXPECT_LE(truth.rows(), 32240U);
  const test::CsvTable targets = test::read_csv(folder.path() / "result/analysis/targets.csv");
  const auto magnitudes = truth.numbers("mag");
  const auto x = truth.numbers("x");
  const auto y = truth.numbers("y");
  std::int64_t outside = 0;  // they shine in from beside the detector
  for (std::size_t i = 0; i < truth.rows(); ++i)
    outside += magnitudes[i] <= 12.0 && (x[i] < -0.5 || x[i] >= 479.5 || y[i] < -0.5 || y[i] >= 479.5) ? 1 : 0;
  const auto bright = std::ranges::count_if(magnitudes, [](double m) { return m <= 12.0; });
  EXPECT_EQ(static_cast<std::int64_t>(targets.rows()), bright - outside);
  EXPECT_GT(targets.rows(), 500U);
  EXPECT_THAT(test::read_file(folder.path() / "result/plan.txt"), HasSubstr("480 x 480 px"));
}

}  // namespace
}  // namespace astroid
