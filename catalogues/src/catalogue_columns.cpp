#include "catalogue_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <span>
#include <string_view>

#include "astroid/catalogues/passbands.hpp"
#include "column_names.hpp"

namespace astroid {

namespace {

using Names = std::span<const std::string_view>;

constexpr std::size_t kMostNamesShown = 30;      // in a message that lists the columns of a file
constexpr std::size_t kFurthestMisspelling = 2;  // letters that a misspelt name may be off

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::optional<std::size_t> find_column(const CatalogueTable& table, std::string_view name, bool exact) {
  const auto& names = table.names();
  const auto same = std::find(names.begin(), names.end(), name);
  if (same != names.end()) return static_cast<std::size_t>(same - names.begin());
  if (exact) return std::nullopt;
  const std::string wanted = lower(name);
  const auto alike = std::find_if(names.begin(), names.end(), [&](const auto& n) { return lower(n) == wanted; });
  if (alike == names.end()) return std::nullopt;
  return static_cast<std::size_t>(alike - names.begin());
}

std::optional<std::size_t> find_first(const CatalogueTable& table, Names candidates) {
  for (const std::string_view name : candidates) {
    if (const auto column = find_column(table, name, false)) return column;
  }
  return std::nullopt;
}

/// Letters to change, add or drop to make one word of another (Levenshtein distance).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row[b.size()];
}

std::string did_you_mean(const CatalogueTable& table, Names candidates) {
  std::size_t best = kFurthestMisspelling + 1;
  std::string found;
  for (const std::string& name : table.names()) {
    for (const std::string_view candidate : candidates) {
      const std::size_t distance = edit_distance(lower(name), lower(candidate));
      // A name half of which would have to change is another word: "id" is no misspelt "ra". One that differs in case
      // alone was refused for that: gmag is no misspelt Gmag.
      if (distance > 0 && distance < best && 2 * distance < candidate.size()) {
        best = distance;
        found = fmt::format("is column {} meant as {}?", name, candidate);
      }
    }
  }
  return found;
}

std::string list_of_columns(const CatalogueTable& table) {
  const auto& names = table.names();
  const std::size_t shown = std::min(names.size(), kMostNamesShown);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < names.size()) text += fmt::format(", … ({} columns)", names.size());
  return text;
}

void report_missing(const CatalogueTable& table, const std::string& what, Names candidates, ProblemList& problems) {
  problems.add(
      {.file = table.file(),
       .line = table.names_line(),
       .parameter = "column " + what,
       .value = {},
       .expected = fmt::format("one of {}; the columns are {}", fmt::join(candidates, ", "), list_of_columns(table)),
       .message = "is missing",
       .suggestion = did_you_mean(table, candidates)});
}

void find_position(const CatalogueTable& table, CatalogueColumns& columns, ProblemList& problems) {
  columns.first = find_first(table, kRaNames);
  columns.second = find_first(table, kDecNames);
  if (columns.first && columns.second) return;
  const auto x = find_first(table, kXNames);
  const auto y = find_first(table, kYNames);
  if (!columns.first && !columns.second && (x || y)) {
    columns.positions = PositionKind::kPixel;
    columns.first = x;
    columns.second = y;
    if (!x) report_missing(table, "x", kXNames, problems);
    if (!y) report_missing(table, "y", kYNames, problems);
    return;
  }
  if (!columns.first) report_missing(table, "ra", kRaNames, problems);
  if (!columns.second) report_missing(table, "dec", kDecNames, problems);
}

struct Candidate {
  std::size_t column;
  std::string passband;
};

std::vector<Candidate> magnitude_columns(const CatalogueTable& table) {
  std::vector<Candidate> found;
  for (const MagnitudeName& known : kPassbandNames) {
    const auto column = find_column(table, known.name, known.exact);
    if (!column) continue;
    const bool seen = std::any_of(found.begin(), found.end(), [&](const auto& c) { return c.column == *column; });
    if (!seen) found.push_back({*column, std::string(known.passband)});
  }
  return found;
}

std::string list_of_bands(const CatalogueTable& table, std::span<const Candidate> candidates) {
  std::vector<std::string> texts;
  for (const Candidate& c : candidates) texts.push_back(fmt::format("{} ({})", table.names()[c.column], c.passband));
  return fmt::format("{}", fmt::join(texts, ", "));
}

void use_plain_magnitude(const CatalogueTable& table, std::size_t column, const std::string& stated,
                         CatalogueColumns& columns, ProblemList& problems) {
  columns.brightness = column;
  const std::string own = canonical_passband(table.stated_passband());
  columns.passband = stated.empty() ? own : stated;
  const std::string name = "column " + table.names()[column];
  if (columns.passband.empty()) {
    problems.add({.file = table.file(),
                  .line = table.names_line(),
                  .parameter = name,
                  .value = {},
                  .expected = "a stated passband: V, V_T, B_T, G, P, T, Kp or the zero point's",
                  .message = "the passband of its magnitudes is not known",
                  .suggestion = {}});
  } else if (!own.empty() && own != columns.passband) {
    problems.add({.file = table.file(),
                  .line = table.names_line(),
                  .parameter = name,
                  .value = {},
                  .expected = {},
                  .message = fmt::format("its passband is {} by a comment of the file, but {} was stated", own,
                                         columns.passband),
                  .suggestion = fmt::format("state passband {}", own)});
  }
}

void find_magnitude(const CatalogueTable& table, const std::string& stated, CatalogueColumns& columns,
                    ProblemList& problems) {
  const std::vector<Candidate> candidates = magnitude_columns(table);
  for (const Candidate& candidate : candidates) {
    if (stated.empty() || candidate.passband != stated) continue;
    columns.brightness = candidate.column;
    columns.passband = stated;
    return;
  }
  if (const auto plain = find_first(table, kMagnitudeNames)) {
    use_plain_magnitude(table, *plain, stated, columns, problems);
    return;
  }
  if (candidates.empty()) {
    std::vector<std::string_view> names(kMagnitudeNames.begin(), kMagnitudeNames.end());
    for (const MagnitudeName& known : kPassbandNames) names.push_back(known.name);
    report_missing(table, "mag", names, problems);
    return;
  }
  if (stated.empty() && candidates.size() == 1) {
    columns.brightness = candidates.front().column;
    columns.passband = candidates.front().passband;
    columns.notes.push_back(fmt::format("passband {} by the name of column {}", columns.passband,
                                        table.names()[candidates.front().column]));
    return;
  }
  Problem problem;
  problem.file = table.file();
  problem.line = table.names_line();
  if (stated.empty()) {
    problem.parameter = "passband";
    problem.message = fmt::format("several columns are magnitudes: {}", list_of_bands(table, candidates));
    problem.expected = "a stated passband, to choose one of them";
  } else {
    const Candidate& candidate = candidates.front();
    problem.parameter = "column " + table.names()[candidate.column];
    problem.message = fmt::format("its magnitudes are in {}, but passband {} was stated", candidate.passband, stated);
    problem.expected =
        fmt::format("a column of magnitudes in {}; there is {}", stated, list_of_bands(table, candidates));
    problem.suggestion =
        fmt::format("state passband {}, which is then converted to the zero point's", candidate.passband);
  }
  problems.add(std::move(problem));
}

void find_brightness(const CatalogueTable& table, const std::string& stated, CatalogueColumns& columns,
                     ProblemList& problems) {
  const auto electrons = find_first(table, kElectronNames);
  const bool has_magnitudes = !magnitude_columns(table).empty() || find_first(table, kMagnitudeNames).has_value();
  if (electrons && (columns.positions == PositionKind::kPixel || !has_magnitudes)) {
    columns.kind = BrightnessKind::kElectrons;
    columns.brightness = electrons;
    return;
  }
  find_magnitude(table, stated, columns, problems);
}

bool find_colour_of(const CatalogueTable& table, const ColourName& known, CatalogueColumns& columns) {
  if (const auto column = find_first(table, known.names)) {
    columns.colour = column;
    columns.colour_index = known.index;
    return true;
  }
  const bool exact = known.index == "B-V";  // bmag is not Bmag in every survey
  for (std::size_t pair = 0; pair < known.blue.size(); ++pair) {
    const auto blue = find_column(table, known.blue[pair], exact);
    const auto red = find_column(table, known.red[pair], exact);
    if (!blue || !red) continue;
    columns.colour = blue;
    columns.colour_red = red;
    columns.colour_index = known.index;
    return true;
  }
  return false;
}

void find_colour(const CatalogueTable& table, CatalogueColumns& columns) {
  // The colour of the magnitudes' own survey first: it needs the fewest relations.
  std::string_view preferred = "B-V";
  if (columns.passband == "V_T" || columns.passband == "B_T") preferred = "B_T-V_T";
  if (columns.passband == "G") preferred = "BP-RP";
  for (const bool own : {true, false}) {
    for (const ColourName& known : kColourNames) {
      if ((known.index == preferred) == own && find_colour_of(table, known, columns)) return;
    }
  }
}

CatalogueColumns bare_columns(const CatalogueTable& table, const std::string& stated, bool positions_only,
                              ProblemList& problems) {
  constexpr std::size_t kBareColumns = 3;  // ra dec mag
  CatalogueColumns columns;
  if (table.columns() != kBareColumns) {
    problems.add(
        {.file = table.file(),
         .line = 1,
         .parameter = {},
         .value = {},
         .expected = "a header line with names such as id,ra,dec,mag, or three columns ra dec mag",
         .message = fmt::format("no header line, and {} column{}", table.columns(), table.columns() == 1 ? "" : "s"),
         .suggestion = {}});
    return columns;
  }
  if (stated.empty() && !positions_only) {
    problems.add({.file = table.file(),
                  .line = 0,
                  .parameter = "passband",
                  .value = {},
                  .expected = "a stated passband: V, V_T, B_T, G, P, T, Kp or the zero point's",
                  .message = "the passband of the magnitudes is not known",
                  .suggestion = {}});
  }
  columns.first = 0;
  columns.second = 1;
  columns.brightness = 2;
  columns.passband = stated;
  columns.notes.emplace_back("no header line: columns taken as ra dec mag");
  return columns;
}

}  // namespace

CatalogueColumns find_columns(const CatalogueTable& table, const CatalogueOptions& options, ProblemList& problems) {
  const std::string stated = options.passband.empty() ? std::string() : canonical_passband(options.passband);
  if (table.names().empty()) return bare_columns(table, stated, options.positions_only, problems);
  CatalogueColumns columns;
  find_position(table, columns, problems);
  if (!options.positions_only) {
    find_brightness(table, stated, columns, problems);
    find_colour(table, columns);
  }
  columns.id = find_first(table, kIdNames);
  columns.teff = find_first(table, kTeffNames);
  const auto pm_ra = find_first(table, kPmRaNames);
  const auto pm_dec = find_first(table, kPmDecNames);
  if (columns.positions == PositionKind::kSky && pm_ra && pm_dec) {
    columns.pm_ra = pm_ra;
    columns.pm_dec = pm_dec;
    columns.epoch = find_first(table, kEpochNames);
  }
  return columns;
}

}  // namespace astroid
