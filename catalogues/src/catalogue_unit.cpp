#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "catalogue_checks.hpp"

namespace astroid {

namespace {

constexpr std::size_t kFewestStars = 100;      // fewer say nothing about a density
constexpr double kSmallestArea = 0.002;        // deg^2: smaller fields may be anything
constexpr double kImplausibleDensity = 500.0;  // times the mean sky; radians for degrees give 3283

struct MeanSky {
  double magnitude;
  double stars_per_square_degree;  // brighter than that, visual, mean of the sky
};
// @source Cox2000 (Allen's Astrophysical Quantities), chapter 19, rounded: only the order of magnitude matters.
constexpr std::array<MeanSky, 5> kMeanSky{{{6.0, 0.12}, {9.0, 3.0}, {12.0, 54.0}, {15.0, 720.0}, {18.0, 6000.0}}};

/// Stars of the magnitudes above, and the box around their positions.
struct Census {
  std::array<std::size_t, kMeanSky.size()> brighter{};
  std::size_t stars = 0;
  double low_ra = 0.0;
  double high_ra = 0.0;
  double low_dec = 0.0;
  double high_dec = 0.0;
};

void include_in(Census& census, double ra, double dec, double magnitude) {
  if (census.stars == 0) {
    census.low_ra = census.high_ra = ra;
    census.low_dec = census.high_dec = dec;
  }
  ++census.stars;
  census.low_ra = std::min(census.low_ra, ra);
  census.high_ra = std::max(census.high_ra, ra);
  census.low_dec = std::min(census.low_dec, dec);
  census.high_dec = std::max(census.high_dec, dec);
  for (std::size_t i = 0; i < kMeanSky.size(); ++i) census.brighter[i] += magnitude < kMeanSky[i].magnitude ? 1U : 0U;
}

Census count_stars(const CatalogueTable& table, const CatalogueColumns& columns) {
  Census census;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto ra = table.number(row, *columns.first);
    const auto dec = table.number(row, *columns.second);
    const auto magnitude = table.number(row, *columns.brightness);
    if (ra && dec && magnitude && std::isfinite(*ra) && std::isfinite(*dec)) include_in(census, *ra, *dec, *magnitude);
  }
  return census;
}

bool looks_like_radians(const Census& census) {
  const bool in_the_box =
      census.low_ra >= 0.0 && census.high_ra <= 2.0 * kPi && std::max(-census.low_dec, census.high_dec) <= kPi / 2.0;
  if (census.stars < kFewestStars || !in_the_box) return false;
  const double area = (census.high_ra - census.low_ra) * (census.high_dec - census.low_dec) *
                      std::cos((census.low_dec + census.high_dec) / 2.0 * (kPi / 180.0));
  if (area < kSmallestArea) return false;
  for (std::size_t i = 0; i < kMeanSky.size(); ++i) {
    const auto stars = static_cast<double>(census.brighter[i]);
    if (census.brighter[i] >= kFewestStars &&
        stars > kImplausibleDensity * area * kMeanSky[i].stars_per_square_degree) {
      return true;
    }
  }
  return false;
}

/// One problem for a column that holds more than an angle in radians can be.
bool check_radians(const CatalogueTable& table, std::size_t column, double largest, ProblemList& problems) {
  std::size_t beyond = 0;
  std::size_t first = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto value = table.number(row, column);
    if (!value || !(std::abs(*value) > largest)) continue;
    if (beyond == 0) first = row;
    ++beyond;
  }
  if (beyond == 0) return true;
  Problem problem =
      table.problem(first, column, fmt::format("{} of {} values are no angle in radians", beyond, table.rows()),
                    fmt::format("at most {:.4f} rad", largest));
  problem.suggestion = "state the unit deg, if these are degrees";
  problems.add(std::move(problem));
  return false;
}

}  // namespace

bool check_unit(const CatalogueTable& table, const CatalogueColumns& columns, const CatalogueOptions& options,
                ProblemList& problems) {
  if (columns.positions == PositionKind::kPixel) return true;
  if (options.unit == AngleUnit::kRadians) {
    const bool ra_fits = check_radians(table, *columns.first, 2.0 * kPi, problems);
    const bool dec_fits = check_radians(table, *columns.second, kPi / 2.0, problems);
    return ra_fits && dec_fits;
  }
  if (!options.check_unit || columns.kind != BrightnessKind::kMagnitude) return true;
  const Census census = count_stars(table, columns);
  if (!looks_like_radians(census)) return true;
  const std::string ra = table.names().empty() ? "1" : table.names()[*columns.first];
  const std::string dec = table.names().empty() ? "2" : table.names()[*columns.second];
  problems.add(
      {.file = table.file(),
       .line = table.names_line(),
       .parameter = fmt::format("columns {} and {}", ra, dec),
       .value = {},
       .expected = "degrees, as stated",
       .message = fmt::format("{} stars with ra {:.4f} .. {:.4f} and dec {:.4f} .. {:.4f} would be hundreds of "
                              "times denser than any field of the sky in degrees; these are radians",
                              census.stars, census.low_ra, census.high_ra, census.low_dec, census.high_dec),
       .suggestion = "state the unit rad"});
  return false;
}

}  // namespace astroid
