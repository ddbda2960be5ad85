#include "astroid/reports/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "astroid/core/csv.hpp"
#include "astroid/test/synthetic_targets.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Columns, AllHaveANameAUnitOfTheProjectAndAMeaning) {
  for (const TableDoc& table : table_docs()) {
    std::set<std::string> names;
    for (const ColumnDoc& column : table.columns) {
      EXPECT_TRUE(names.insert(column.name).second) << table.file << ": " << column.name << " twice";
      EXPECT_EQ(column.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos)
          << column.name;
      EXPECT_THAT(column.meaning, Not(IsEmpty())) << table.file << ": " << column.name;
      EXPECT_THAT(column.unit, AnyOf("", "mag", "px", "e-", "ppm", "s", "MiB")) << column.name;
    }
  }
}

TEST(Columns, ContainThoseThatTheProductsPromise) {
  std::set<std::string> names;
  for (const auto& column : target_columns()) names.insert(column.name);
  for (const char* promised :
       {"id", "mag", "mask_pixels", "enclosed_fraction", "nsr_exposure", "nsr_1h_ppm", "spr_tot", "crowdsap",
        "flfrcsap", "nsr_exposure_measured", "nsr_1h_ppm_measured", "nsr_1h_ppm_measured_err", "flags"}) {
    EXPECT_EQ(names.count(promised), 1U) << promised;
  }
}

TEST(Columns, AreDocumentedAllAndNoOthers) {
  const std::string page = columns_markdown();
  std::size_t documented = 0;
  for (const TableDoc& table : table_docs()) {
    EXPECT_THAT(page, HasSubstr("## " + table.file));
    for (const ColumnDoc& column : table.columns)
      EXPECT_THAT(page, HasSubstr("| " + column.name + " | " + column.unit + " | "));
    documented += table.columns.size();
  }
  // A line of a table each, besides the flags, and a heading and a rule per table.
  const auto lines = static_cast<std::size_t>(std::count(page.begin(), page.end(), '\n'));
  std::size_t table_lines = 0;
  for (std::size_t at = page.find("\n|"); at != std::string::npos; at = page.find("\n|", at + 1)) ++table_lines;
  EXPECT_EQ(table_lines, documented + flag_names().size() + 2 * (table_docs().size() + 1));
  EXPECT_GT(lines, table_lines);
}

TEST(Tables, WriteTheDocumentedColumnsAndTheValues) {
  const test::TemporaryFolder folder;
  const auto targets = test::synthetic_targets({.stars = 30});
  const auto path = folder.path() / "targets.csv";
  write_table(path, target_columns(), std::span<const TargetMetrics>(targets));
  const CsvTable table = read_csv(path);
  ASSERT_EQ(table.header().size(), target_columns().size());
  for (std::size_t c = 0; c < table.columns(); ++c) EXPECT_EQ(table.header()[c], target_columns()[c].name);
  ASSERT_EQ(table.rows(), targets.size());
  const auto value = [&table](std::size_t row, const char* name) { return *table.number(row, *table.column(name)); };
  for (std::size_t row = 0; row < targets.size(); ++row) {
    EXPECT_EQ(table.field(row, 0), targets[row].id);
    EXPECT_EQ(value(row, "mag"), targets[row].mag);
    EXPECT_EQ(value(row, "nsr_1h_ppm"), targets[row].nsr_1h_ppm);
    EXPECT_EQ(value(row, "nsr_1h_ppm_measured"), targets[row].nsr_1h_scaled.value);
    EXPECT_EQ(value(row, "nsr_1h_simulated_ppm_measured"), targets[row].nsr_1h_measured.value);
    EXPECT_EQ(table.field(row, *table.column("flags")), flag_text(targets[row].flags));
    const double causes = std::sqrt(
        std::pow(value(row, "nsr_1h_photon_ppm"), 2) + std::pow(value(row, "nsr_1h_contaminants_ppm"), 2) +
        std::pow(value(row, "nsr_1h_background_ppm"), 2) + std::pow(value(row, "nsr_1h_readout_ppm"), 2) +
        std::pow(value(row, "nsr_1h_quantisation_ppm"), 2) + std::pow(value(row, "nsr_1h_background_estimate_ppm"), 2) +
        std::pow(value(row, "nsr_1h_jitter_ppm"), 2) + std::pow(value(row, "nsr_1h_prnu_jitter_ppm"), 2) +
        std::pow(value(row, "nsr_1h_smearing_ppm"), 2) + std::pow(value(row, "nsr_1h_bias_ppm"), 2) +
        std::pow(value(row, "nsr_1h_drift_ppm"), 2));
    EXPECT_NEAR(causes / value(row, "nsr_1h_ppm"), 1.0, 1e-12);
    EXPECT_NEAR(value(row, "delta_mag"),
                value(row, "delta_contamination") + value(row, "delta_aperture_loss") + value(row, "delta_smearing") +
                    value(row, "delta_residual"),
                1e-12);
  }
}

TEST(Tables, WriteNanForWhatDoesNotExist) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "contamination.csv";
  const std::vector<ContaminationRow> rows{{"A, the \"first\"", 11.0, 0.1, -0.11, {{"B", 1.0, 2.0, 100.0, 0.1}}}};
  write_table(path, contamination_columns(), std::span<const ContaminationRow>(rows));
  const CsvTable table = read_csv(path);
  EXPECT_EQ(table.field(0, 0), "A, the \"first\"");
  EXPECT_EQ(table.field(0, *table.column("contaminant1_id")), "B");
  EXPECT_EQ(*table.number(0, *table.column("contaminant1_spr")), 0.1);
  EXPECT_EQ(table.field(0, *table.column("contaminant2_id")), "");
  EXPECT_EQ(table.field(0, *table.column("contaminant2_spr")), "nan");
}

}  // namespace
}  // namespace astroid
