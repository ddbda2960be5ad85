// Rows of the small tables of reference values beside these tests.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "astroid/test/temporary_folder.hpp"

namespace astroid::test {

inline std::vector<std::vector<std::string>> csv_rows(const std::string& name) {
  std::ifstream file(source_dir() / "tests/reference/core/data" / name);
  if (!file) throw std::runtime_error("cannot read " + name);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

}  // namespace astroid::test
