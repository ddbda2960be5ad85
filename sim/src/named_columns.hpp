// Columns of numbers in the small files that describe a scene, found by name.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

template <std::size_t N>
using NamedColumns = std::array<std::optional<std::size_t>, N>;

/// The columns by name, or the first ones where the file has no header; complains about each that is missing.
template <std::size_t N>
NamedColumns<N> find_named_columns(const CsvTable& table, const std::array<const char*, N>& names,
                                   const std::string& expected, std::vector<Problem>& problems) {
  NamedColumns<N> columns;
  for (std::size_t i = 0; i < N; ++i) {
    if (table.header().empty()) {
      if (i < table.columns()) columns[i] = i;
    } else {
      columns[i] = table.column(names[i]);
    }
    if (!columns[i])
      problems.push_back({.file = table.file(),
                          .line = table.header_line(),
                          .parameter = fmt::format("column {}", names[i]),
                          .expected = expected,
                          .message = "the column is missing"});
  }
  return columns;
}

/// The numbers of a row; nothing, and a complaint about each field that is none.
template <std::size_t N>
std::optional<std::array<double, N>> finite_numbers(const CsvTable& table, std::size_t row,
                                                    const NamedColumns<N>& columns, std::vector<Problem>& problems) {
  std::array<double, N> values{};
  bool good = true;
  for (std::size_t i = 0; i < N; ++i) {
    const std::optional<double> value = table.number(row, *columns[i]);
    if (value && std::isfinite(*value)) {
      values[i] = *value;
    } else {
      problems.push_back(table.problem(row, *columns[i], "is not a finite number", "a number"));
      good = false;
    }
  }
  if (!good) return std::nullopt;
  return values;
}

}  // namespace astroid
