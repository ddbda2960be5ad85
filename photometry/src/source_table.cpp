// The table of sources, as text and as FITS.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "astroid/core/csv.hpp"
#include "astroid/core/fits_writer.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

namespace {

struct SourceColumn {
  const char* name;
  const char* unit;
  double SourceMeasurement::*value;
};

constexpr std::array kColumns{SourceColumn{"x", "pixel", &SourceMeasurement::x},
                              SourceColumn{"y", "pixel", &SourceMeasurement::y},
                              SourceColumn{"ra", "deg", &SourceMeasurement::ra},
                              SourceColumn{"dec", "deg", &SourceMeasurement::dec},
                              SourceColumn{"flux", "electron", &SourceMeasurement::flux},
                              SourceColumn{"flux_err", "electron", &SourceMeasurement::flux_err},
                              SourceColumn{"mag", "mag", &SourceMeasurement::mag},
                              SourceColumn{"mag_err", "mag", &SourceMeasurement::mag_err},
                              SourceColumn{"background", "electron", &SourceMeasurement::background},
                              SourceColumn{"snr", "", &SourceMeasurement::snr},
                              SourceColumn{"chi2", "", &SourceMeasurement::chi2}};

// Written only where some source has them.
constexpr std::array kMoreColumns{SourceColumn{"position_err", "pixel", &SourceMeasurement::position_err},
                                  SourceColumn{"crowding", "mag", &SourceMeasurement::crowding},
                                  SourceColumn{"sharpness", "", &SourceMeasurement::sharpness}};

std::vector<SourceColumn> more_columns(std::span<const SourceMeasurement> sources) {
  std::vector<SourceColumn> columns;
  for (const SourceColumn& column : kMoreColumns)
    if (std::any_of(sources.begin(), sources.end(),
                    [&column](const SourceMeasurement& s) { return std::isfinite(s.*column.value); }))
      columns.push_back(column);
  return columns;
}

}  // namespace

void write_sources(const std::filesystem::path& path, std::span<const SourceMeasurement> sources) {
  const std::vector<SourceColumn> more = more_columns(sources);
  std::vector<std::string> names{"id"};
  for (const SourceColumn& column : kColumns) names.emplace_back(column.name);
  names.emplace_back("flags");
  for (const SourceColumn& column : more) names.emplace_back(column.name);
  CsvWriter csv(path, names);
  for (const SourceMeasurement& s : sources) {
    csv.cell(s.id);
    for (const SourceColumn& column : kColumns) csv.cell(s.*column.value);
    csv.cell(s.flags);
    for (const SourceColumn& column : more) csv.cell(s.*column.value);
    csv.end_row();
  }
  csv.commit();
}

void write_sources_fits(const std::filesystem::path& path, std::span<const SourceMeasurement> sources,
                        std::span<const FitsCard> cards, std::span<const std::string> history) {
  std::vector<SourceColumn> columns(kColumns.begin(), kColumns.end());
  for (const SourceColumn& column : more_columns(sources)) columns.push_back(column);
  std::size_t width = 1;
  for (const SourceMeasurement& s : sources) width = std::max(width, s.id.size());
  std::vector<FitsColumn> description{{.name = "id", .text_width = static_cast<int>(width)}};
  for (const SourceColumn& column : columns) description.push_back({.name = column.name, .unit = column.unit});
  description.push_back({.name = "flags", .number = FitsNumber::kInt32});
  FitsWriter fits(path);
  (void)fits.begin_table(description, "SOURCES", static_cast<std::int64_t>(sources.size()));
  fits.cards(cards);
  for (const std::string& line : history) fits.history(line);
  if (!sources.empty()) {
    std::vector<std::string> ids;
    std::vector<std::int32_t> flags;
    for (const SourceMeasurement& s : sources) {
      ids.push_back(s.id);
      flags.push_back(static_cast<std::int32_t>(s.flags));
    }
    fits.write_column(0, 0, ids);
    std::vector<double> values(sources.size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (std::size_t i = 0; i < sources.size(); ++i) values[i] = sources[i].*columns[c].value;
      fits.write_column(c + 1, 0, values);
    }
    fits.write_column(columns.size() + 1, 0, flags);
  }
  fits.commit();
}

}  // namespace astroid
