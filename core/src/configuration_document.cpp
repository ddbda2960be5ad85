#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "configuration_draft.hpp"
#include "configuration_names.hpp"
#include "configuration_units.hpp"
#include "configuration_value.hpp"

namespace astroid::configuration {

namespace {

constexpr std::string_view kVersion = "1";
constexpr std::size_t kLongestQuote = 60;  // bytes of a value that a message repeats

std::string quoted_briefly(std::string_view text) {
  if (text.size() <= kLongestQuote) return std::string(text);
  std::size_t end = kLongestQuote;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not inside a UTF-8 character
  return std::string(text.substr(0, end)) + "...";
}

/// Where something was written, for problems and origins.
struct Place {
  std::string_view file;
  long line;
};

void complain(Draft& draft, const Place& place, std::string_view path, ValueError error, std::string_view value = {}) {
  draft.bad.emplace(path);
  draft.problems.push_back({.file = std::string(place.file),
                            .line = place.line,
                            .parameter = std::string(path),
                            .value = quoted_briefly(value),
                            .expected = std::move(error.expected),
                            .message = std::move(error.message),
                            .suggestion = std::move(error.suggestion)});
}

/// Parses and stores one value.
/// @param as_written  the value with its unit, for messages.
void take_value(const Parameter& parameter, std::string_view text, std::string_view unit, const std::string& as_written,
                const Place& place, const std::vector<std::filesystem::path>& folders, Draft& draft) {
  ParsedValue parsed = parse_value(parameter, text, unit, folders);
  if (parsed.error) {
    complain(draft, place, parameter.path, *std::move(parsed.error), as_written);
    return;
  }
  draft.given.insert_or_assign(std::string(parameter.path), Given{std::move(parsed.value), std::string(place.file),
                                                                  place.line, quoted_briefly(as_written)});
}

/// The unit attribute, checked. Null after a complaint.
const std::string* checked_unit(const Parameter& parameter, const XmlElement& element, Draft& draft) {
  static const std::string none;
  if (parameter.unit.empty()) return &none;
  const Place place{draft.file, element.line};
  for (const XmlAttribute& attribute : element.attributes) {
    if (attribute.name != "unit") continue;
    if (find_conversion(parameter.unit, attribute.value) != nullptr) return &attribute.value;
    complain(draft, place, parameter.path,
             {fmt::format("the unit \"{}\" does not fit", quoted_briefly(attribute.value)),
              unit_expectation(parameter.unit), ""},
             element.text);
    return nullptr;
  }
  if (draft.bad.contains(join_path(parameter.path, "unit"))) {  // a misspelt "unit": said already
    draft.bad.emplace(parameter.path);
    return nullptr;
  }
  complain(draft, place, parameter.path, {"has no unit", unit_expectation(parameter.unit), ""}, element.text);
  return nullptr;
}

void read_attributes(const XmlElement& element, std::string_view path, Draft& draft) {
  const Place place{draft.file, element.line};
  const Parameter* owner = find_parameter(path);
  for (const XmlAttribute& attribute : element.attributes) {
    const std::string attribute_path = join_path(path, attribute.name);
    const Parameter* parameter = find_parameter(attribute_path);
    if (parameter != nullptr && parameter->is_attribute) {
      take_value(*parameter, trimmed(attribute.value), parameter->unit, attribute.value, place, draft.folders, draft);
    } else if (attribute.name != "origin" && (attribute.name != "unit" || owner == nullptr)) {
      complain(draft, place, attribute_path, {"unknown attribute", "", suggest_attribute(attribute.name, path, draft)},
               attribute.value);
    } else if (attribute.name == "unit" && owner->unit.empty()) {
      complain(draft, place, path, {"this parameter has no unit", "no attribute unit", ""}, element.text);
    }
  }
}

void read_parameter(const Parameter& parameter, const XmlElement& element, Draft& draft) {
  const Place place{draft.file, element.line};
  for (const XmlElement& child : element.children) {
    complain(draft, {draft.file, child.line}, join_path(parameter.path, child.name),
             {fmt::format("{} holds a value, not elements", last_name(parameter.path)), "",
              suggest_element(child.name, parameter.path, draft)});
    draft.bad.emplace(parameter.path);
  }
  const std::string* unit = checked_unit(parameter, element, draft);
  if (unit == nullptr || draft.bad.contains(parameter.path)) return;
  const bool shows_unit = !unit->empty() && !element.text.empty();
  const std::string as_written = shows_unit ? fmt::format("{} {}", element.text, *unit) : element.text;
  take_value(parameter, element.text, *unit, as_written, place, draft.folders, draft);
}

void read_children(const XmlElement& element, std::string_view path, Draft& draft);

/// Reads on below a misspelt section as if it were the one that was meant, so that its parameters don't seem missing.
void read_misspelt_section(const XmlElement& element, std::string_view section, Draft& draft) {
  const std::string meant = join_path(section, nearest_name(element.name, element_names(section)));
  if (!is_section(meant) || !draft.elements.emplace(meant, element.line).second) return;
  read_attributes(element, meant, draft);
  read_children(element, meant, draft);
}

void read_element(const XmlElement& element, std::string_view section, Draft& draft) {
  const Place place{draft.file, element.line};
  const std::string path = join_path(section, element.name);
  const Parameter* parameter = find_parameter(path);
  const bool is_value = parameter != nullptr && !parameter->is_attribute;
  if (!is_value && !is_section(path)) {
    const bool seems_section = element.text.empty() && !(element.children.empty() && element.attributes.empty());
    const std::string_view kind = seems_section ? "unknown section" : "unknown parameter";
    complain(draft, place, path, {std::string(kind), "", suggest_element(element.name, section, draft)}, element.text);
    read_misspelt_section(element, section, draft);
    return;
  }
  const auto [first, is_new] = draft.elements.emplace(path, element.line);
  if (!is_new) {
    complain(draft, place, path, {fmt::format("given twice, first on line {}", first->second), "", ""});
    return;
  }
  read_attributes(element, path, draft);
  if (is_value) {
    read_parameter(*parameter, element, draft);
  } else {
    read_children(element, path, draft);
  }
}

void read_children(const XmlElement& element, std::string_view path, Draft& draft) {
  if (!element.text.empty()) {
    const std::string name = path.empty() ? "Astroid" : std::string(path);
    draft.problems.push_back({.file = draft.file,
                              .line = element.line,
                              .parameter = name,
                              .value = quoted_briefly(element.text),
                              .message = "text between elements",
                              .suggestion = "remove it or write it as a comment <!-- ... -->"});
  }
  for (const XmlElement& child : element.children) read_element(child, path, draft);
}

void read_root_attributes(const XmlElement& root, Draft& draft) {
  const Place place{draft.file, root.line};
  const std::string expected = fmt::format("<Astroid version=\"{}\">", kVersion);
  bool has_version = false;
  for (const XmlAttribute& attribute : root.attributes) {
    if (attribute.name == "version") {
      has_version = true;
      if (trimmed(attribute.value) != kVersion) {
        complain(draft, place, "Astroid/version", {"unknown version of the configuration", expected, ""},
                 attribute.value);
      }
    } else if (attribute.name != "origin") {
      complain(draft, place, join_path("Astroid", attribute.name), {"unknown attribute", expected, ""},
               attribute.value);
    }
  }
  if (!has_version) complain(draft, place, "Astroid", {"has no version", expected, ""});
}

/// An override taken apart: "CCD/Gain=25 e-/ADU" -> path, value, unit.
struct Override {
  std::string_view path, value, unit;
};

/// Splits "25 e-/ADU" or "25e-/ADU" where the number ends, for parameters that have a unit.
void split_unit(const Parameter& parameter, Override& change) {
  change.unit = parameter.unit;
  if (parameter.unit.empty()) return;
  const std::vector<std::string_view> units = accepted_units(parameter.unit);
  std::string_view longest;
  for (const std::string_view unit : units) {
    if (change.value.ends_with(unit) && unit.size() > longest.size()) longest = unit;
  }
  if (longest.empty() || longest.size() == change.value.size()) return;
  const std::string_view number = change.value.substr(0, change.value.size() - longest.size());
  constexpr std::string_view kEndsOfNumbers = "0123456789. \t";
  if (kEndsOfNumbers.find(number.back()) == std::string_view::npos) return;
  change.unit = longest;
  change.value = trimmed(number);
}

void read_override(std::string_view text, const std::vector<std::filesystem::path>& folders, Draft& draft) {
  const Place place{kOverrideOrigin, 0};
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) {
    complain(draft, place, trimmed(text), {"has no value", "Path/To/Parameter=value", ""});
    return;
  }
  Override change{trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1)), {}};
  const Parameter* parameter = find_parameter(change.path);
  if (parameter == nullptr) {
    const bool names_section = is_section(change.path);
    complain(draft, place, change.path,
             {names_section ? "a section, not a parameter" : "unknown parameter", "",
              names_section ? "" : suggest_path(change.path)},
             change.value);
    return;
  }
  const std::string as_written(change.value);
  split_unit(*parameter, change);
  take_value(*parameter, change.value, change.unit, as_written, place, folders, draft);
}

/// True where the parent element of an attribute is present, in the file or through an override.
bool parent_is_present(std::string_view parent, const Draft& draft) {
  if (draft.elements.contains(parent)) return true;
  return std::any_of(draft.given.begin(), draft.given.end(),
                     [&](const auto& entry) { return parent_path(entry.first) == parent; });
}

}  // namespace

void read_document(const XmlElement& root, Draft& draft) {
  if (root.name != "Astroid") {
    complain(draft, {draft.file, root.line}, root.name,
             {"is not the root element of a configuration", fmt::format("<Astroid version=\"{}\">", kVersion), ""});
    return;
  }
  draft.elements.emplace("", root.line);
  read_root_attributes(root, draft);
  read_children(root, "", draft);
}

void read_overrides(const ConfigurationSurroundings& surroundings, Draft& draft) {
  std::vector<std::filesystem::path> folders = {std::filesystem::current_path()};
  folders.insert(folders.end(), draft.folders.begin(), draft.folders.end());
  for (const std::string& text : surroundings.overrides) read_override(text, folders, draft);
}

void fill_defaults(Draft& draft) {
  for (const Parameter& parameter : parameter_table()) {
    if (draft.given.contains(parameter.path) || draft.bad.contains(parameter.path)) continue;
    const std::string_view parent = parent_path(parameter.path);
    const bool is_missing =
        parameter.is_required || (parameter.is_required_in_parent && parent_is_present(parent, draft));
    if (is_missing) {
      std::string_view nearest = parent;
      while (!nearest.empty() && !draft.elements.contains(nearest)) nearest = parent_path(nearest);
      const auto line = draft.elements.find(nearest);
      complain(draft, {draft.file, line == draft.elements.end() ? 0 : line->second}, parameter.path,
               {"is missing", expectation(parameter), ""});
    } else if (!parameter.fallback.empty()) {
      ParsedValue parsed = parse_value(parameter, parameter.fallback, parameter.unit, {});
      if (parsed.error) throw BugError(fmt::format("default of {}: {}", parameter.path, parsed.error->message));
      const std::string as_written =
          fmt::format("{}{}{} (default)", parameter.fallback, parameter.unit.empty() ? "" : " ", parameter.unit);
      draft.given.emplace(parameter.path, Given{std::move(parsed.value), "", 0, as_written});
    }
  }
}

}  // namespace astroid::configuration
