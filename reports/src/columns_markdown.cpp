#include <fmt/format.h>

#include "astroid/reports/tables.hpp"

namespace astroid {

namespace {

/// A cell of a Markdown table: a bar would end it.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

void write_noise_budget(const std::filesystem::path& path, std::span<const BudgetRow> rows) {
  write_table(path, budget_columns(), rows);
}

std::vector<TableDoc> table_docs() {
  return {
      {"targets.csv", "one target", column_docs(target_columns())},
      {"noise_vs_magnitude.csv", "one bin of magnitude", column_docs(noise_columns())},
      {"magnitude_recovery.csv", "one bin of magnitude", column_docs(recovery_columns())},
      {"contamination.csv", "one target and its strongest neighbours", column_docs(contamination_columns())},
      {"noise_budget.csv", "one magnitude, predicted without a simulation", column_docs(budget_columns())},
      {"focal_plane.csv", "one sub-field (`astroid focal-plane`)", column_docs(focal_plane_columns())},
      {"focal_plane_map.csv", "one place on the detector (`astroid focal-plane`)",
       column_docs(focal_plane_map_columns())},
      {"tradeoff.csv", "one setting (`astroid tradeoff`)", column_docs(tradeoff_columns())},
  };
}

std::string columns_markdown() {
  std::string text =
      "# Columns of the tables in analysis/\n\n"
      "Files are CSV with one header line. `nan` stands for a number that does not exist.\n";
  for (const TableDoc& table : table_docs()) {
    text +=
        fmt::format("\n## {}\n\nA row is {}.\n\n| column | unit | meaning |\n|---|---|---|\n", table.file, table.row);
    for (const ColumnDoc& column : table.columns) {
      text += fmt::format("| {} | {} | {} |\n", cell(column.name), cell(column.unit), cell(column.meaning));
    }
  }
  text += "\n## Flags\n\n| name | meaning |\n|---|---|\n";
  for (const FlagName& flag : flag_names()) text += fmt::format("| {} | {} |\n", flag.name, flag.meaning);
  return text;
}

}  // namespace astroid
