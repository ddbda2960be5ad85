// The units a configuration may use, and what else than the documented one is understood.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace astroid::configuration {

/// value [unit] = value [alternative] * multiply / divide
struct UnitConversion {
  std::string_view unit;
  std::string_view alternative;
  double multiply;
  double divide;
};

/// The conversion from `alternative` to `unit` (identity where they are the same), or null where there is none.
const UnitConversion* find_conversion(std::string_view unit, std::string_view alternative);

/// Every way to write the unit of a parameter documented in `unit`, that one first.
std::vector<std::string_view> accepted_units(std::string_view unit);

/// `unit="s" (or ms, min, h, d)`
std::string unit_expectation(std::string_view unit);

}  // namespace astroid::configuration
