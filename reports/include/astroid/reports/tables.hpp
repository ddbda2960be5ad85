// The tables of analysis/: their columns, with units and meaning, and the page that documents them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/budget.hpp"
#include "astroid/analysis/contamination.hpp"
#include "astroid/analysis/focal_plane.hpp"
#include "astroid/analysis/noise_vs_magnitude.hpp"
#include "astroid/analysis/recovery.hpp"
#include "astroid/analysis/target_metrics.hpp"
#include "astroid/analysis/tradeoff.hpp"
#include "astroid/reports/column.hpp"

namespace astroid {

inline constexpr std::size_t kListedContaminants = 3;  ///< per star in contamination.csv

std::span<const Column<TargetMetrics>> target_columns();            ///< targets.csv
std::span<const Column<NoiseBin>> noise_columns();                  ///< noise_vs_magnitude.csv
std::span<const Column<RecoveryBin>> recovery_columns();            ///< magnitude_recovery.csv
std::span<const Column<ContaminationRow>> contamination_columns();  ///< contamination.csv
std::span<const Column<BudgetRow>> budget_columns();                ///< noise_budget.csv

/// The surfaces over the focal plane at one place.
struct FocalPlaneMapRow {
  double x, y;  ///< px
  FocalPlaneValue nsr_predicted, nsr_measured, spr, recovery;
};
std::span<const Column<SubFieldMetrics>> focal_plane_columns();       ///< focal_plane.csv
std::span<const Column<FocalPlaneMapRow>> focal_plane_map_columns();  ///< focal_plane_map.csv

std::span<const Column<TradeoffRow>> tradeoff_columns();  ///< tradeoff.csv

/// noise_budget.csv alone, for `astroid budget --analytic`. @throws EnvironmentError(path, cause)
void write_noise_budget(const std::filesystem::path& path, std::span<const BudgetRow> rows);

/// A table's file name, what a row is, and its columns.
struct TableDoc {
  std::string file;
  std::string row;
  std::vector<ColumnDoc> columns;
};
/// All tables of analysis/.
std::vector<TableDoc> table_docs();

/// report/columns.md: every column of every table, its unit and meaning, and the measurement flags.
std::string columns_markdown();

}  // namespace astroid
