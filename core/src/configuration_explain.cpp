#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "astroid/core/configuration.hpp"
#include "astroid/core/error.hpp"
#include "configuration_draft.hpp"
#include "configuration_names.hpp"
#include "configuration_parameter.hpp"
#include "configuration_units.hpp"
#include "configuration_value.hpp"
#include "configuration_xml.hpp"

namespace astroid {

namespace {

using configuration::Kind;
using configuration::Parameter;

std::string default_text(const Parameter& parameter) {
  if (parameter.is_required) return "none: it must be given";
  if (parameter.is_required_in_parent) {
    return fmt::format("none: it must be given where there is a {}",
                       configuration::last_name(configuration::parent_path(parameter.path)));
  }
  if (parameter.fallback.empty()) return "not set";
  const bool has_unit = !parameter.unit.empty() && parameter.fallback != parameter.keyword;
  return has_unit ? fmt::format("{} {}", parameter.fallback, parameter.unit) : std::string(parameter.fallback);
}

/// `<ReadoutNoise unit="e-">50.2</ReadoutNoise>`, `<ZeroPoint passband="P" ...>`
std::string example_element(const Parameter& parameter) {
  const std::string_view name = configuration::last_name(parameter.path);
  if (parameter.is_attribute) {
    return fmt::format("<{} {}=\"{}\" ...>", configuration::last_name(configuration::parent_path(parameter.path)), name,
                       parameter.example);
  }
  const std::string unit = parameter.unit.empty() ? "" : fmt::format(" unit=\"{}\"", parameter.unit);
  return fmt::format("<{0}{1}>{2}</{0}>", name, unit, parameter.example);
}

std::string example_override(const Parameter& parameter) {
  const bool has_blank = parameter.example.find(' ') != std::string_view::npos;
  return fmt::format("--set {0}{1}={2}{0}", has_blank ? "'" : "", parameter.path, parameter.example);
}

std::string kind_text(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::kReal:
      return parameter.keyword.empty() ? "number" : fmt::format("number, or {}", parameter.keyword);
    case Kind::kInteger:
      return "integer";
    case Kind::kBoolean:
      return "on or off";
    case Kind::kText:
      return "text";
    case Kind::kChoice:
      return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
    case Kind::kFile:
      return "name of a file, sought in the configuration's folder, then among the program's data";
    case Kind::kTime:
      return "date and time, ISO 8601";
    case Kind::kIntegerList:
      return "integers separated by blanks";
    case Kind::kRealList:
      return "numbers separated by blanks";
  }
  return {};
}

std::string unit_text(const Parameter& parameter) {
  std::vector<std::string_view> units = configuration::accepted_units(parameter.unit);
  if (units.size() < 2) return std::string(parameter.unit);
  units.erase(units.begin());
  return fmt::format("{} (also {})", parameter.unit, fmt::join(units, ", "));
}

std::string explain_parameter(const Parameter& parameter) {
  std::string out = fmt::format("{}\n  {}\n", parameter.path, parameter.meaning);
  const auto line = [&](std::string_view label, std::string_view text) {
    if (!text.empty()) out += fmt::format("  {:<9}{}\n", label, text);
  };
  line("value", kind_text(parameter));
  line("unit", unit_text(parameter));
  line("range", configuration::range_text(parameter.range));
  line("default", default_text(parameter));
  line("example", example_element(parameter));
  line("", example_override(parameter));
  return out;
}

std::string list_below(std::string_view section) {
  std::size_t width = 0;
  for (const Parameter& parameter : configuration::parameter_table()) width = std::max(width, parameter.path.size());
  std::string out;
  for (const Parameter& parameter : configuration::parameter_table()) {
    if (!section.empty() && !parameter.path.starts_with(fmt::format("{}/", section))) continue;
    out += fmt::format("{:<{}}  {}\n", parameter.path, width, parameter.meaning);
  }
  return out;
}

/// True where `name` is the end of `path`, from a slash or the beginning on.
bool ends_path(std::string_view path, std::string_view name) {
  if (name.size() > path.size()) return false;
  const std::size_t start = path.size() - name.size();
  return configuration::equal_ignoring_case(path.substr(start), name) && (start == 0 || path[start - 1] == '/');
}

/// All sections, outer before inner.
std::vector<std::string> sections(const std::string& parent = "") {
  std::vector<std::string> all;
  for (const std::string& name : configuration::element_names(parent)) {
    const std::string path = configuration::join_path(parent, name);
    if (!configuration::is_section(path)) continue;
    all.push_back(path);
    const std::vector<std::string> inner = sections(path);
    all.insert(all.end(), inner.begin(), inner.end());
  }
  return all;
}

std::string markdown_cell(std::string text) {
  std::size_t position = 0;
  while ((position = text.find('|', position)) != std::string::npos) {
    text.insert(position, "\\");
    position += 2;
  }
  return text;
}

std::string value_cell(const Parameter& parameter) {
  const std::string range = configuration::range_text(parameter.range);
  if (parameter.kind == Kind::kFile) return "file";
  if (parameter.kind == Kind::kTime) return "date and time, TDB";
  if (!parameter.keyword.empty()) return fmt::format("number, {}, or {}", range, parameter.keyword);
  const std::string kind = kind_text(parameter);
  return range.empty() ? kind : fmt::format("{}, {}", kind, range);
}

std::string reference_table(const std::string& section) {
  std::string rows;
  for (const Parameter& parameter : configuration::parameter_table()) {
    if (configuration::parent_path(parameter.path) != section) {
      const bool belongs_to_child =
          parameter.is_attribute && !configuration::is_section(configuration::parent_path(parameter.path));
      if (!belongs_to_child || configuration::parent_path(configuration::parent_path(parameter.path)) != section) {
        continue;
      }
    }
    const std::string_view name = parameter.path.substr(section.size() + 1);
    rows += markdown_cell(fmt::format("`{}`{}", name, parameter.is_attribute ? " (attribute)" : "")).insert(0, "| ");
    for (const std::string& cell :
         {unit_text(parameter), value_cell(parameter), default_text(parameter), std::string(parameter.meaning)}) {
      rows += " | " + markdown_cell(cell);
    }
    rows += " |\n";
  }
  if (rows.empty()) return {};
  return "\n| parameter | unit | value | default | meaning |\n|---|---|---|---|---|\n" + rows;
}

}  // namespace

std::string explain(std::string_view name) {
  const std::string_view wanted = configuration::trimmed(name);
  if (wanted.empty()) return list_below("");
  std::string out;
  for (const std::string& section : sections()) {
    if (!ends_path(section, wanted)) continue;
    out += fmt::format("{}{}\n  {}\n\n{}", out.empty() ? "" : "\n", section, configuration::section_meaning(section),
                       list_below(section));
  }
  for (const Parameter& parameter : configuration::parameter_table()) {
    if (ends_path(parameter.path, wanted)) out += (out.empty() ? "" : "\n") + explain_parameter(parameter);
  }
  if (out.empty()) {
    throw InputError(Problem{.parameter = std::string(wanted),
                             .message = "no such parameter",
                             .suggestion = configuration::suggest_path(wanted)});
  }
  return out;
}

std::string reference_page_markdown() {
  std::string out =
      "# The configuration\n"
      "\n"
      "Made from the parameter table of the program (`core/src/configuration_table_*.cpp`); a test compares the two.\n"
      "`astroid explain NAME` says the same about one parameter, `astroid validate FILE` checks a file,\n"
      "`astroid init plato` writes one to start from.\n"
      "\n"
      "* The root element is `<Astroid version=\"1\">`; elements may stand in any order, each at most once.\n"
      "* A parameter with a unit states it: `<ReadoutNoise unit=\"e-\">50.2</ReadoutNoise>`. Other units that are\n"
      "  understood are converted.\n"
      "* A missing parameter takes its default; an unknown one is an error.\n"
      "* Attributes are addressed like children: `Telescope/ZeroPoint/passband`.\n"
      "* `--set CCD/ReadoutNoise=30` on the command line, or `--set 'Simulation/Cycle=500 ms'`, wins over the file.\n"
      "* Files are sought in the configuration's folder, then among the program's data; those named in `--set` in the\n"
      "  current folder first.\n"
      "* The attribute `origin`, which the product `config.xml` writes, may stand anywhere and is ignored.\n";
  for (const std::string& section : sections()) {
    const bool is_inner = section.find('/') != std::string::npos;
    out += fmt::format("\n{} {}\n\n{}\n", is_inner ? "###" : "##", section, configuration::section_meaning(section));
    out += reference_table(section);
  }
  return out;
}

}  // namespace astroid
