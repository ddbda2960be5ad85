// Text -> value of one parameter, with what is wrong in words.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

/// What is wrong with a value.
struct ValueError {
  std::string message;
  std::string expected;
  std::string suggestion;
};

/// Either a value or an error.
struct ParsedValue {
  Value value;
  std::optional<ValueError> error;
};

/// Checks and converts one value.
///
/// @param text     without surrounding blanks.
/// @param unit     as written; the parameter's own where it has none.
/// @param folders  where a file is looked for, in this order.
ParsedValue parse_value(const Parameter& parameter, std::string_view text, std::string_view unit,
                        const std::vector<std::filesystem::path>& folders);

/// "a number from 0 to 100000 e-", "one of CCD, CMOS", "a file" …
std::string expectation(const Parameter& parameter);

/// "0 to 100000", "greater than 0, at most 1e+06", "at least 0", empty without bounds.
std::string range_text(const Range& range);

/// Without blanks, tabs and line breaks at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace astroid::configuration
