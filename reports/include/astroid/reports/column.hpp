// A table described once: the same list of columns writes the CSV file and documents it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "astroid/core/csv.hpp"

namespace astroid {

using Cell = std::variant<std::string, double, std::int64_t>;

/// One column of a CSV file.
template <class Row>
struct Column {
  std::string name;
  std::string unit;     ///< empty: a plain number or text
  std::string meaning;  ///< one sentence
  std::function<Cell(const Row&)> value;
};

/// Name, unit and meaning of a column, for documentation.
struct ColumnDoc {
  std::string name, unit, meaning;
};

template <class Row>
std::vector<ColumnDoc> column_docs(std::span<const Column<Row>> columns) {
  std::vector<ColumnDoc> docs;
  for (const Column<Row>& column : columns) docs.push_back({column.name, column.unit, column.meaning});
  return docs;
}

/// Writes rows as a CSV file. @throws EnvironmentError(path, cause)
template <class Row>
void write_table(const std::filesystem::path& path, std::span<const Column<Row>> columns, std::span<const Row> rows) {
  std::vector<std::string> names;
  for (const Column<Row>& column : columns) names.push_back(column.name);
  CsvWriter writer(path, names);
  for (const Row& row : rows) {
    for (const Column<Row>& column : columns) {
      std::visit([&writer](const auto& value) { writer.cell(value); }, column.value(row));
    }
    writer.end_row();
  }
  writer.commit();
}

}  // namespace astroid
