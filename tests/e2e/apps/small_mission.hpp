// A mission small enough to run in a fraction of a second: 100 x 100 px, 25 stars on a grid.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "astroid/test/temporary_folder.hpp"

namespace astroid::test {

/// Writes stars.csv (id,ra,dec,mag; magnitudes 8.5 to 13.3, 14 px apart, each at another place within its pixel) and
/// small.xml (jitter, dark current, PRNU, read noise; 6 exposures of 25 s) and returns the latter.
std::filesystem::path write_small_mission(const TemporaryFolder& folder);

/// Writes a catalogue (id,x,y,electrons) of stars s0, s1 ... at random places of a square of `side` px, most of them
/// near the faintest, 4000 e-, with `more` lines at the end.
void write_pixel_field(const std::filesystem::path& file, int side, int stars, const std::string& more);

/// A CSV table of a product: columns by name.
struct CsvTable {
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> columns;
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const;
  [[nodiscard]] const std::vector<std::string>& texts(const std::string& name) const { return columns.at(name); }
  [[nodiscard]] std::size_t rows() const { return names.empty() ? 0 : columns.at(names.front()).size(); }
};
CsvTable read_csv(const std::filesystem::path& file);

}  // namespace astroid::test
