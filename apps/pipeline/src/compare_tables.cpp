#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "astroid/analysis/recovery.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/pipeline/analyse_run.hpp"
#include "astroid/reports/tables.hpp"
#include "folders.hpp"

namespace astroid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMatchRadius = 1.0;  // px

/// One row of either table.
struct Entry {
  std::string id;
  double x = kNaN, y = kNaN, magnitude = kNaN, flux = kNaN, flux_err = kNaN;
};

/// A column that a table may have under several names.
struct Wanted {
  std::vector<std::string> names;
  bool required;
  double Entry::*member;
};

std::vector<Entry> read_entries(const std::filesystem::path& path, const std::vector<Wanted>& wanted,
                                std::vector<Problem>& problems) {
  const CsvTable table = read_csv(path, {.header = CsvHeader::kPresent});
  const std::optional<std::size_t> id = table.column("id");
  std::vector<std::pair<std::size_t, double Entry::*>> columns;
  for (const Wanted& column : wanted) {
    std::optional<std::size_t> found;
    for (const std::string& name : column.names)
      if (!found) found = table.column(name);
    if (found) {
      columns.emplace_back(*found, column.member);
    } else if (column.required) {
      problems.push_back({.file = path.string(),
                          .line = table.header_line(),
                          .parameter = fmt::format("column {}", column.names.front()),
                          .message = "the column is missing"});
    }
  }
  std::vector<Entry> entries;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Entry entry;
    if (id) entry.id = std::string(table.field(row, *id));
    for (const auto& [column, member] : columns) {
      const std::optional<double> value = table.number(row, column);
      if (!value) {
        problems.push_back(table.problem(row, column, "is not a number", "a number, or nan"));
        continue;
      }
      entry.*member = *value;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

/// Index of the source of each truth star, by id or by position.
std::vector<std::optional<std::size_t>> match(const std::vector<Entry>& truth, const std::vector<Entry>& sources,
                                              std::string& how) {
  std::vector<std::optional<std::size_t>> matches(truth.size());
  std::unordered_map<std::string, std::size_t> by_id;
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (!sources[i].id.empty()) by_id.emplace(sources[i].id, i);
  std::size_t found = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto at = by_id.find(truth[i].id);
    if (at == by_id.end()) continue;
    matches[i] = at->second;
    ++found;
  }
  if (found > 0) {
    how = "by id";
    return matches;
  }
  how = fmt::format("by position within {} px, brightest first", kMatchRadius);
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
  constexpr std::int64_t kStride = 1'000'003;  // cells of one pixel; the stride keeps columns and rows apart
  const auto cell = [](double x, double y) {
    return static_cast<std::int64_t>(std::floor(x)) * kStride + static_cast<std::int64_t>(std::floor(y));
  };
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (std::isfinite(sources[i].x) && std::isfinite(sources[i].y))
      cells[cell(sources[i].x, sources[i].y)].push_back(i);
  std::vector<std::size_t> order(truth.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return truth[i].magnitude; });
  std::vector<bool> used(sources.size(), false);
  for (const std::size_t i : order) {
    double nearest = kMatchRadius * kMatchRadius;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto at = cells.find(cell(truth[i].x + dx, truth[i].y + dy));
        if (at == cells.end()) continue;
        for (const std::size_t s : at->second) {
          const double d = std::pow(sources[s].x - truth[i].x, 2) + std::pow(sources[s].y - truth[i].y, 2);
          if (used[s] || d >= nearest) continue;
          nearest = d;
          matches[i] = s;
        }
      }
    if (matches[i]) used[*matches[i]] = true;
  }
  return matches;
}

}  // namespace

TableComparison compare_tables(const std::filesystem::path& truth_file, const std::filesystem::path& sources_file,
                               const std::filesystem::path& output) {
  std::vector<Problem> problems;
  const std::vector<Entry> truth = read_entries(truth_file,
                                                {{{"x"}, true, &Entry::x},
                                                 {{"y"}, true, &Entry::y},
                                                 {{"mag"}, true, &Entry::magnitude},
                                                 {{"electrons", "flux"}, true, &Entry::flux}},
                                                problems);
  const std::vector<Entry> sources = read_entries(sources_file,
                                                  {{{"x"}, true, &Entry::x},
                                                   {{"y"}, true, &Entry::y},
                                                   {{"flux"}, true, &Entry::flux},
                                                   {{"flux_err"}, true, &Entry::flux_err},
                                                   {{"mag"}, false, &Entry::magnitude}},
                                                  problems);
  if (!problems.empty()) throw InputError(std::move(problems));

  TableComparison comparison{.truth = truth.size(), .sources = sources.size(), .notes = {}};
  std::string how;
  const auto matches = match(truth, sources, how);
  create_folder(output);
  CsvWriter csv(output / "matched.csv", {"id", "mag", "x", "y", "electrons", "flux", "flux_err", "delta_mag", "pull"});
  std::vector<TargetMetrics> targets;
  double pull_squares = 0.0;
  std::size_t pulls = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!matches[i]) continue;
    const Entry& t = truth[i];
    const Entry& s = sources[*matches[i]];
    const double delta = s.flux > 0.0 ? -2.5 * std::log10(s.flux / t.flux) : kNaN;
    const double pull = (s.flux - t.flux) / s.flux_err;
    csv.row(t.id, t.magnitude, t.x, t.y, t.flux, s.flux, s.flux_err, delta, pull);
    ++comparison.matched;
    if (std::isfinite(pull)) {
      pull_squares += pull * pull;
      ++pulls;
    }
    TargetMetrics target;
    target.id = t.id;
    target.mag = t.magnitude;
    target.x = t.x;
    target.y = t.y;
    target.enclosed_fraction = 1.0;
    target.flux_in = target.flux_expected = t.flux;
    target.exposures = 1;
    target.flux_measured = s.flux;
    target.flux_err = s.flux_err;
    target.mag_measured = t.magnitude + delta;
    target.mag_err = 2.5 / std::log(10.0) * s.flux_err / s.flux;
    target.delta_mag = target.causes.residual = delta;
    targets.push_back(std::move(target));
  }
  csv.commit();
  const RunSetup setup;
  const std::vector<RecoveryBin> bins = magnitude_recovery(targets, setup);
  write_table<RecoveryBin>(output / "magnitude_recovery.csv", recovery_columns(), bins);
  const RecoverySummary summary = recovery_summary(targets, setup);
  constexpr double kMilli = 1e3;
  comparison.bias_mmag = kMilli * summary.bias;
  comparison.bias_error_mmag = kMilli * summary.bias_err;
  comparison.pull_width = pulls > 0 ? std::sqrt(pull_squares / static_cast<double>(pulls)) : kNaN;
  comparison.notes.push_back(fmt::format("stars were matched {}", how));
  return comparison;
}

}  // namespace astroid
