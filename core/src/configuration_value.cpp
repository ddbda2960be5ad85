#include "configuration_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

#include "astroid/core/calendar.hpp"
#include "configuration_names.hpp"
#include "configuration_units.hpp"

namespace astroid::configuration {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

ParsedValue failure(const Parameter& parameter, std::string message, std::string suggestion = {}) {
  return {{}, ValueError{std::move(message), expectation(parameter), std::move(suggestion)}};
}

/// A leading plus sign is usual in files, but not for std::from_chars.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  return text;
}

struct Number {
  double value = 0.0;
  std::string_view rest;  ///< what follows the number
  std::errc error = {};
};

Number take_number(std::string_view text) {
  Number number;
  text = without_plus(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number.value);
  number.rest = text.substr(static_cast<std::size_t>(end - text.data()));
  number.error = error;
  return number;
}

/// The message for a text that is not wholly a number.
ParsedValue not_a_number(const Parameter& parameter, std::string_view text, const Number& number) {
  if (number.error == std::errc::invalid_argument || number.rest.size() == text.size()) {
    return failure(parameter, "not a number");
  }
  if (number.rest.starts_with(',')) return failure(parameter, "not a number", "write a decimal point, not a comma");
  return failure(parameter, fmt::format("\"{}\" follows the number", trimmed(number.rest)));
}

ParsedValue parse_real(const Parameter& parameter, std::string_view text, std::string_view unit) {
  if (!parameter.keyword.empty() && text == parameter.keyword) {
    Value value;
    value.is_keyword = true;
    value.text = std::string(text);
    return {value, std::nullopt};
  }
  const Number number = take_number(text);
  if (number.error == std::errc::result_out_of_range && number.rest.empty()) {
    return failure(parameter, "beyond what a number can hold");
  }
  if (number.error != std::errc() || !number.rest.empty()) return not_a_number(parameter, text, number);
  if (!std::isfinite(number.value)) return failure(parameter, "not a finite number");
  const UnitConversion* conversion = find_conversion(parameter.unit, unit);
  Value value;
  value.real = conversion == nullptr ? number.value : number.value * conversion->multiply / conversion->divide;
  if (value.real == 0.0) value.real = 0.0;  // no negative zero
  if (!parameter.range.contains(value.real)) return failure(parameter, "out of range");
  value.text = fmt::format("{}", value.real);
  return {value, std::nullopt};
}

ParsedValue parse_integer(const Parameter& parameter, std::string_view text) {
  Value value;
  const std::string_view digits = without_plus(text);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value.integer);
  if (error == std::errc::result_out_of_range) return failure(parameter, "out of range");
  if (error != std::errc() || end != digits.data() + digits.size()) {
    const Number number = take_number(text);
    const bool is_number = number.error == std::errc() && number.rest.empty() && std::isfinite(number.value);
    return is_number ? failure(parameter, "not an integer") : not_a_number(parameter, text, number);
  }
  if (!parameter.range.contains(static_cast<double>(value.integer))) return failure(parameter, "out of range");
  value.text = fmt::format("{}", value.integer);
  return {value, std::nullopt};
}

ParsedValue parse_boolean(const Parameter& parameter, std::string_view text) {
  Value value;
  for (const std::string_view yes : {"on", "true", "yes", "1"}) value.flag = value.flag || text == yes;
  bool is_no = false;
  for (const std::string_view no : {"off", "false", "no", "0"}) is_no = is_no || text == no;
  if (!value.flag && !is_no) return failure(parameter, "neither on nor off");
  value.text = value.flag ? "on" : "off";
  return {value, std::nullopt};
}

/// "every 10" for the choice "every N".
ParsedValue parse_counted_choice(const Parameter& parameter, std::size_t index, std::string_view count) {
  Value value;
  value.choice = index;
  constexpr std::int64_t kLargestCount = 1000000000;
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), value.integer);
  const bool whole = error == std::errc() && end == count.data() + count.size();
  if (!whole || value.integer < 1 || value.integer > kLargestCount) {
    return failure(parameter, fmt::format("N in \"{}\" must be an integer of at least 1", parameter.choices[index]));
  }
  const std::string_view choice = parameter.choices[index];
  value.text = fmt::format("{} {}", choice.substr(0, choice.size() - kCountedSuffix.size()), value.integer);
  return {value, std::nullopt};
}

ParsedValue parse_choice(const Parameter& parameter, std::string_view text) {
  for (std::size_t i = 0; i < parameter.choices.size(); ++i) {
    const std::string_view choice = parameter.choices[i];
    if (choice.ends_with(kCountedSuffix)) {
      const std::string_view word = choice.substr(0, choice.size() - kCountedSuffix.size());
      const std::string_view first = text.substr(0, text.find_first_of(kBlanks));
      if (first == word) return parse_counted_choice(parameter, i, trimmed(text.substr(first.size())));
    }
    if (text == choice) {
      Value value;
      value.choice = i;
      value.text = std::string(choice);
      return {value, std::nullopt};
    }
  }
  const std::string near = nearest_name(text, {parameter.choices.begin(), parameter.choices.end()});
  return failure(parameter, "not one of the choices", near.empty() ? "" : fmt::format("did you mean {}?", near));
}

ParsedValue parse_file(const Parameter& parameter, std::string_view text,
                       const std::vector<std::filesystem::path>& folders) {
  const std::filesystem::path name{text};
  std::vector<std::string> tried;
  for (const auto& folder : folders) {
    const std::filesystem::path path = std::filesystem::absolute(folder / name).lexically_normal();
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) {
      if (std::filesystem::is_directory(path, ignored)) return failure(parameter, "a folder, not a file");
      if (!std::ifstream(path)) return failure(parameter, "the file cannot be read");
      Value value;
      value.text = path.string();
      return {value, std::nullopt};
    }
    if (name.is_absolute()) break;
  }
  return failure(parameter, "no such file");
}

ParsedValue parse_time(const Parameter& parameter, std::string_view text) {
  constexpr double kFirst = 15020.0;  // 1900-01-01, MJD
  constexpr double kLast = 124594.0;  // 2200-01-01
  const auto mjd = mjd_from_iso8601(text);
  if (!mjd) {
    const bool has_zone = text.ends_with('Z') && mjd_from_iso8601(text.substr(0, text.size() - 1));
    return failure(parameter, "not a date and time", has_zone ? "leave out the Z: the time scale is TDB" : "");
  }
  if (*mjd < kFirst || *mjd > kLast) return failure(parameter, "out of range");
  Value value;
  value.real = *mjd;
  value.text = std::string(text);
  return {value, std::nullopt};
}

/// Numbers separated by blanks or commas, each parsed by `parse` and handed to `take`.
template <class Parse, class Take>
std::optional<ParsedValue> parse_items(std::string_view text, Parse&& parse, Take&& take) {
  constexpr std::string_view kSeparators = " \t\r\n,";
  while (!(text = text.substr(std::min(text.size(), text.find_first_not_of(kSeparators)))).empty()) {
    const std::string_view item = text.substr(0, text.find_first_of(kSeparators));
    ParsedValue parsed = parse(item);
    if (parsed.error) {
      parsed.error->message = fmt::format("\"{}\" is {}", item, parsed.error->message);
      return parsed;
    }
    take(parsed.value);
    text.remove_prefix(item.size());
  }
  return std::nullopt;
}

ParsedValue parse_integer_list(const Parameter& parameter, std::string_view text) {
  Value list;
  if (const auto bad = parse_items(
          text, [&](std::string_view item) { return parse_integer(parameter, item); },
          [&](const Value& value) { list.integers.push_back(value.integer); }))
    return *bad;
  list.text = fmt::format("{}", fmt::join(list.integers, " "));
  return {list, std::nullopt};
}

ParsedValue parse_real_list(const Parameter& parameter, std::string_view text, std::string_view unit) {
  Value list;
  if (const auto bad = parse_items(
          text, [&](std::string_view item) { return parse_real(parameter, item, unit); },
          [&](const Value& value) { list.reals.push_back(value.real); }))
    return *bad;
  list.text = fmt::format("{}", fmt::join(list.reals, " "));
  return {list, std::nullopt};
}

std::string with_unit(std::string_view text, std::string_view unit) {
  return unit.empty() ? std::string(text) : fmt::format("{} {}", text, unit);
}

std::string number_expectation(std::string_view noun, const Parameter& parameter) {
  const std::string range = range_text(parameter.range);
  std::string text(noun);
  if (!range.empty()) text += (range.starts_with("at least") || range.starts_with("greater") ? ", " : " from ") + range;
  text = with_unit(text, parameter.unit);
  if (!parameter.keyword.empty()) text += fmt::format(", or {}", parameter.keyword);
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string range_text(const Range& range) {
  if (std::isinf(range.minimum)) return {};
  if (std::isinf(range.maximum)) return fmt::format("at least {}", range.minimum);
  if (range.minimum_is_open) return fmt::format("greater than {}, at most {}", range.minimum, range.maximum);
  return fmt::format("{} to {}", range.minimum, range.maximum);
}

std::string expectation(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::kReal:
      return number_expectation("a number", parameter);
    case Kind::kInteger:
      return number_expectation("an integer", parameter);
    case Kind::kIntegerList:
      return number_expectation("integers separated by blanks, each", parameter);
    case Kind::kRealList:
      return number_expectation("numbers separated by blanks, each", parameter);
    case Kind::kBoolean:
      return "on or off";
    case Kind::kChoice:
      return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
    case Kind::kText:
      return "text";
    case Kind::kFile:
      return "the name of a readable file";
    case Kind::kTime:
      return "a date and time like 2027-01-01T00:00:00 (TDB), between 1900 and 2200";
  }
  return {};
}

ParsedValue parse_value(const Parameter& parameter, std::string_view text, std::string_view unit,
                        const std::vector<std::filesystem::path>& folders) {
  if (text.empty() && parameter.kind != Kind::kIntegerList && parameter.kind != Kind::kRealList)
    return failure(parameter, "has no value");
  switch (parameter.kind) {
    case Kind::kReal:
      return parse_real(parameter, text, unit);
    case Kind::kInteger:
      return parse_integer(parameter, text);
    case Kind::kIntegerList:
      return parse_integer_list(parameter, text);
    case Kind::kRealList:
      return parse_real_list(parameter, text, unit);
    case Kind::kBoolean:
      return parse_boolean(parameter, text);
    case Kind::kChoice:
      return parse_choice(parameter, text);
    case Kind::kFile:
      return parse_file(parameter, text, folders);
    case Kind::kTime:
      return parse_time(parameter, text);
    case Kind::kText:
      break;
  }
  Value value;
  value.text = std::string(text);
  return {value, std::nullopt};
}

}  // namespace astroid::configuration
