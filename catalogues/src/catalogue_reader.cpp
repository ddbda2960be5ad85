#include "astroid/catalogues/catalogue_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "catalogue_checks.hpp"
#include "catalogue_columns.hpp"
#include "catalogue_table.hpp"
#include "problem_list.hpp"

namespace astroid {

namespace {

constexpr double kBrightestMagnitude = -30.0;  // brighter than the Sun, -26.8
constexpr double kFaintestMagnitude = 40.0;    // fainter than any telescope sees; 99 means "none" in many catalogues
constexpr double kBluestColour = -2.0;         // mag; beyond are marks for "none"
constexpr double kReddestColour = 10.0;        // mag
constexpr double kCoolestStar = 500.0;         // K
constexpr double kHottestStar = 500000.0;      // K

struct Bounds {
  double low;
  double high;
  const char* text;
};

bool is_missing(std::string_view text) {
  constexpr std::array<std::string_view, 11> kMarks{"",   "nan", "NaN", "null", "NULL",  "Null",
                                                    "--", "N/A", "n/a", "None", "masked"};
  for (const std::string_view mark : kMarks) {
    if (text == mark) return true;
  }
  return false;
}

/// Reads the rows of one table; problems and counts gather here.
class RowReader {
 public:
  RowReader(const CatalogueTable& table, const CatalogueColumns& columns, const CatalogueOptions& options,
            ProblemList& problems)
      : table_(table), columns_(columns), options_(options), problems_(problems) {}

  void read_all(StarCatalogue& catalogue, std::vector<std::size_t>& rows) {
    catalogue.stars.reserve(table_.rows());
    rows.reserve(table_.rows());
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      CatalogueStar star;
      if (columns_.positions == PositionKind::kSky) {
        read_sky(row, star);
      } else {
        read_pixel(row, star);
      }
      if (!read_brightness(row, star)) continue;
      star.colour = read_colour(row);
      star.teff = columns_.teff ? optional_number(row, *columns_.teff, {kCoolestStar, kHottestStar, ""}) : kUnknown;
      read_proper_motion(row, star);
      if (columns_.id) star.id = table_.text(row, *columns_.id);
      if (is_missing(star.id)) star.id.clear();
      catalogue.stars.push_back(std::move(star));
      rows.push_back(row);
    }
    if (left_out_ > 0) {
      catalogue.notes.push_back(fmt::format("{} stars without a magnitude are left out", left_out_));
    }
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  void report(std::size_t row, std::size_t column, const std::string& message, const std::string& expected) {
    problems_.add(table_.problem(row, column, message, expected));
  }

  double number(std::size_t row, std::size_t column, const Bounds& bounds) {
    const auto value = table_.number(row, column);
    if (!value) {
      const std::string text = table_.text(row, column);
      const bool sexagesimal = text.find(':') != std::string::npos;
      report(row, column, is_missing(text) ? "no value" : "not a number",
             sexagesimal ? fmt::format("{}, as a decimal number", bounds.text) : bounds.text);
      return kUnknown;
    }
    if (std::isnan(*value)) {
      report(row, column, "not a number (NaN)", bounds.text);
    } else if (!(*value >= bounds.low && *value <= bounds.high)) {
      report(row, column, "out of range", bounds.text);
    }
    return *value;
  }

  /// NaN where the value is missing or a mark outside `bounds`; text is a problem.
  double optional_number(std::size_t row, std::size_t column, const Bounds& bounds) {
    const auto value = table_.number(row, column);
    if (!value) {
      if (!is_missing(table_.text(row, column))) report(row, column, "not a number", "a number, or nothing");
      return kUnknown;
    }
    return *value >= bounds.low && *value <= bounds.high ? *value : kUnknown;
  }

  void read_sky(std::size_t row, CatalogueStar& star) {
    double ra = 0.0;
    double dec = 0.0;
    if (options_.unit == AngleUnit::kRadians) {
      ra = to_degrees(Radians(number(row, *columns_.first, {0.0, 2.0 * kPi, "0 .. 2 pi rad"}))).value();
      dec = to_degrees(Radians(number(row, *columns_.second, {-kPi / 2.0, kPi / 2.0, "-pi/2 .. pi/2 rad"}))).value();
    } else {
      ra = number(row, *columns_.first, {0.0, 360.0, "0 .. 360 deg"});
      dec = number(row, *columns_.second, {-90.0, 90.0, "-90 .. 90 deg"});
    }
    star.sky = {ra >= 360.0 ? ra - 360.0 : ra + 0.0, dec};  // + 0.0 turns -0 into 0
  }

  void read_pixel(std::size_t row, CatalogueStar& star) {
    constexpr double kFarthest = 1e6;  // px: a thousand times the half width of a large detector
    const Bounds bounds{-kFarthest, kFarthest, "-1e6 .. 1e6 px"};
    star.pixel = {number(row, *columns_.first, bounds), number(row, *columns_.second, bounds)};
  }

  bool read_brightness(std::size_t row, CatalogueStar& star) {
    if (options_.positions_only) return true;
    const std::size_t column = *columns_.brightness;
    if (columns_.kind == BrightnessKind::kElectrons) {
      constexpr double kMostElectrons = 1e15;  // per exposure
      star.electrons = number(row, column, {0.0, kMostElectrons, "0 .. 1e15 electrons"});
      return true;
    }
    if (options_.leave_out_missing) {
      const auto value = table_.number(row, column);
      if (value ? std::isnan(*value) : is_missing(table_.text(row, column))) {
        ++left_out_;
        return false;
      }
    }
    star.magnitude = Magnitude(number(row, column, {kBrightestMagnitude, kFaintestMagnitude, "-30 .. 40 mag"}));
    return true;
  }

  void read_proper_motion(std::size_t row, CatalogueStar& star) {
    if (!columns_.pm_ra || !columns_.pm_dec) return;
    constexpr double kFastest = 20000.0;  // mas/yr: twice Barnard's star; beyond are marks for "none"
    constexpr double kFirstYear = 1800.0;
    constexpr double kLastYear = 2200.0;
    const Bounds motions{-kFastest, kFastest, ""};
    const double ra = optional_number(row, *columns_.pm_ra, motions);
    const double dec = optional_number(row, *columns_.pm_dec, motions);
    if (std::isnan(ra) || std::isnan(dec)) return;
    star.pm_ra = ra;
    star.pm_dec = dec;
    const double epoch = columns_.epoch ? optional_number(row, *columns_.epoch, {kFirstYear, kLastYear, ""}) : kUnknown;
    if (!std::isnan(epoch)) star.epoch = epoch;
  }

  double read_colour(std::size_t row) {
    if (!columns_.colour) return kUnknown;
    const Bounds colours{kBluestColour, kReddestColour, ""};
    if (!columns_.colour_red) return optional_number(row, *columns_.colour, colours);
    const Bounds magnitudes{kBrightestMagnitude, kFaintestMagnitude, ""};
    const double blue = optional_number(row, *columns_.colour, magnitudes);
    const double red = optional_number(row, *columns_.colour_red, magnitudes);
    const double colour = blue - red;
    return colour >= kBluestColour && colour <= kReddestColour ? colour : kUnknown;
  }

  const CatalogueTable& table_;
  const CatalogueColumns& columns_;
  const CatalogueOptions& options_;
  ProblemList& problems_;
  std::size_t left_out_ = 0;
};

void check_stated_units(const CatalogueTable& table, const CatalogueColumns& columns, const CatalogueOptions& options,
                        ProblemList& problems) {
  if (columns.positions == PositionKind::kPixel) return;
  const std::string_view other = options.unit == AngleUnit::kDegrees ? "rad" : "deg";
  for (const auto column : {columns.first, columns.second}) {
    if (!column || table.unit(*column) != other) continue;
    problems.add({.file = table.file(),
                  .line = table.names_line(),
                  .parameter = "column " + table.names()[*column],
                  .value = {},
                  .expected = options.unit == AngleUnit::kDegrees ? "deg, as stated" : "rad, as stated",
                  .message = fmt::format("the file gives its unit as {}", other),
                  .suggestion = fmt::format("state the unit {}", other)});
  }
}

}  // namespace

StarCatalogue read_catalogue(const std::filesystem::path& path, const CatalogueOptions& options) {
  const std::unique_ptr<CatalogueTable> table = read_catalogue_table(path);
  ProblemList problems(table->file(), options.most_problems);
  if (table->rows() == 0) {
    problems.add({.file = table->file(),
                  .line = table->names_line(),
                  .parameter = {},
                  .value = {},
                  .expected = "one line per star",
                  .message = "the catalogue has no stars",
                  .suggestion = {}});
  }
  const CatalogueColumns columns = find_columns(*table, options, problems);
  check_stated_units(*table, columns, options, problems);
  problems.throw_if_any();

  StarCatalogue catalogue;
  catalogue.source = path.string();
  catalogue.passband = columns.passband;
  catalogue.colour_index = columns.colour_index;
  catalogue.positions = columns.positions;
  catalogue.brightness = columns.kind;
  catalogue.notes = columns.notes;
  if (!check_unit(*table, columns, options, problems)) problems.throw_if_any();
  std::vector<std::size_t> rows;
  RowReader(*table, columns, options, problems).read_all(catalogue, rows);
  name_stars(*table, columns, rows, catalogue, problems);
  problems.throw_if_any();
  return catalogue;
}

}  // namespace astroid
