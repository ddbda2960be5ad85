#include "configuration_units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <numbers>

namespace astroid::configuration {

namespace {

// Decimal factors are divisors where the alternative is the smaller unit, so that "100 ms" is the double nearest 0.1.
constexpr std::array kConversions = {
    UnitConversion{"s", "s", 1, 1},
    UnitConversion{"s", "ms", 1, 1000},
    UnitConversion{"s", "min", 60, 1},
    UnitConversion{"s", "h", 3600, 1},
    UnitConversion{"s", "d", 86400, 1},
    UnitConversion{"d", "d", 1, 1},
    UnitConversion{"d", "h", 1, 24},
    UnitConversion{"d", "s", 1, 86400},
    UnitConversion{"yr", "yr", 1, 1},
    UnitConversion{"deg", "deg", 1, 1},
    UnitConversion{"deg", "rad", 180, std::numbers::pi},
    UnitConversion{"deg", "arcmin", 1, 60},
    UnitConversion{"deg", "arcsec", 1, 3600},
    UnitConversion{"arcsec", "arcsec", 1, 1},
    UnitConversion{"arcsec", "mas", 1, 1000},
    UnitConversion{"arcsec", "arcmin", 60, 1},
    UnitConversion{"arcsec", "deg", 3600, 1},
    UnitConversion{"arcsec/d", "arcsec/d", 1, 1},
    UnitConversion{"arcsec/d", "mas/d", 1, 1000},
    UnitConversion{"arcsec/px", "arcsec/px", 1, 1},
    UnitConversion{"arcsec/px", "mas/px", 1, 1000},
    UnitConversion{"arcsec/px", "deg/px", 3600, 1},
    UnitConversion{"ppm", "ppm", 1, 1},
    UnitConversion{"ppm", "%", 1e4, 1},
    UnitConversion{"%", "%", 1, 1},
    UnitConversion{"%", "ppm", 1, 1e4},
    UnitConversion{"mag", "mag", 1, 1},
    UnitConversion{"mag", "mmag", 1, 1000},
    UnitConversion{"S10", "S10", 1, 1},
    UnitConversion{"e-", "e-", 1, 1},
    UnitConversion{"e-", "ke-", 1000, 1},
    UnitConversion{"e-/px/s", "e-/px/s", 1, 1},
    UnitConversion{"e-/px/s", "e-/s/px", 1, 1},
    UnitConversion{"e-/ADU", "e-/ADU", 1, 1},
    UnitConversion{"ADU", "ADU", 1, 1},
    UnitConversion{"px", "px", 1, 1},
    UnitConversion{"K", "K", 1, 1},
    UnitConversion{"um", "um", 1, 1},
    UnitConversion{"um", "mm", 1000, 1},
    UnitConversion{"m2", "m2", 1, 1},
    UnitConversion{"1/px", "1/px", 1, 1},
    UnitConversion{"px/e-", "px/e-", 1, 1},
    UnitConversion{"e-/um", "e-/um", 1, 1},
    UnitConversion{"1/cm2/s", "1/cm2/s", 1, 1},
};

}  // namespace

const UnitConversion* find_conversion(std::string_view unit, std::string_view alternative) {
  for (const UnitConversion& conversion : kConversions) {
    if (conversion.unit == unit && conversion.alternative == alternative) return &conversion;
  }
  return nullptr;
}

std::vector<std::string_view> accepted_units(std::string_view unit) {
  std::vector<std::string_view> units;
  for (const UnitConversion& conversion : kConversions) {
    if (conversion.unit == unit) units.push_back(conversion.alternative);
  }
  return units;
}

std::string unit_expectation(std::string_view unit) {
  std::vector<std::string_view> units = accepted_units(unit);
  std::string text = fmt::format("unit=\"{}\"", unit);
  if (units.size() > 1) {
    units.erase(units.begin());
    text += fmt::format(" (or {})", fmt::join(units, ", "));
  }
  return text;
}

}  // namespace astroid::configuration
